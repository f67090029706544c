// bind_first_order.h -- additions of bind_first_order.cpp to the class of prescriptions.
#pragma once
#include <nanobind/nanobind.h>

#include "optics/lens/prescription.h"

void bind_first_order(nanobind::module_& m, nanobind::class_<dg::Prescription>& lens);
