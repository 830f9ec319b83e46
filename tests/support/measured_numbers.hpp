// Surfaces whose measurement is known without one.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene/bsdf/measurement.hpp"

namespace lightnet::test {

/// The same number in all tables but for the areas, so that radiance of `colour` / 4 goes everywhere, whatever the way.
Measurement::Numbers even_numbers(Rgb colour, float area = 1);

/// GGX facets (α along x and y) of a metal that reflects `colour` from any angle, with `nodes` along each side of a
/// grid. Where both α are the same it is measured from one azimuth, else from all around or, folded, from parts.
Measurement::Numbers ggx_numbers(float alpha_u, float alpha_v, Rgb colour, std::uint32_t nodes,
                                 std::uint32_t folds = 1);

/// RGL's file of it, with the `rgb` variant of colours or, where wavelengths are given, with the same spectrum of
/// `colour`.r everywhere.
std::string tensor_file_of(const Measurement::Numbers& numbers, const std::vector<float>& wavelengths = {});

/// A field of a tensor file; `type` as in TensorFile::Type.
struct TensorField {
    std::string name;
    std::uint8_t type = 0;
    std::vector<std::uint64_t> shape;
    std::string bytes;
};
/// Each begins at a multiple of `aligned` bytes.
std::string tensor_file(const std::vector<TensorField>& fields, std::size_t aligned = 1);
/// The fields of tensor_file_of().
std::vector<TensorField> tensor_fields_of(const Measurement::Numbers& numbers,
                                          const std::vector<float>& wavelengths = {});

}  // namespace lightnet::test
