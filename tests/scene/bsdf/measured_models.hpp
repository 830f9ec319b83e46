// Measured surfaces, made when they are wanted.
#pragma once

#include "core/scene/bsdf/measured.hpp"
#include "tests/support/measured_numbers.hpp"

namespace lightnet::models_test {

inline MeasuredBsdf measured_metal() {
    static const Measurement metal(test::ggx_numbers(0.4f, 0.4f, {0.8f, 0.5f, 0.2f}, 64));
    return {&metal};
}
inline MeasuredBsdf measured_grooves() {
    static const Measurement grooves(test::ggx_numbers(0.3f, 0.5f, {0.8f, 0.5f, 0.2f}, 48, 2));
    return {&grooves};
}

}  // namespace lightnet::models_test
