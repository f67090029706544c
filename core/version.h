// version.h -- the one version number; CMake, Python and the EXR metadata read it from here.
#pragma once
#define DG_VERSION "0.1.0"
