// test_targets.h -- runs tests of kernels on every instruction set.
#pragma once
#include <doctest/doctest.h>
#include <hwy/targets.h>

#include <string>

#include "optics/trace/trace_simd.h"

namespace dg::test {

/// Runs the body for each instruction set that is compiled in and supported by this machine.
template <typename Body>
void for_each_target(Body body) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        INFO("target " << hwy::TargetName(target));
        CHECK(std::string(simd_target_name()) == hwy::TargetName(target));
        body();
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace dg::test
