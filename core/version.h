// version.h -- the one version number (PEP 440); CMake, Python and the EXR metadata read it from here.
#pragma once
#define DG_VERSION "1.0.0rc1"
