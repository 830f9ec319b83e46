// A shape whose points are shaded many at once.
#pragma once

#include <cstdint>

#include "core/base/math/rgb.hpp"
#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

class Shading;

/// A mesh that is filled with nothing and has no grooves. Others are shaded point by point.
/// DECISIONS: plain-surfaces-in-columns
struct ColumnShape {
    enum class Kind : std::uint8_t {
        none,             // it is another
        lambertian,       // an ideal diffuse reflector
        coated,           // CoatedDiffuseBsdf, of facets by the GGX law
        coated_beckmann,  // the same, by Beckmann's
        metal,            // ConductorBsdf, not smooth, of facets by the GGX law
        metal_beckmann,   // the same, by Beckmann's
        principled,       // PrincipledBsdf, opaque, without cloth
    };
    Kind kind = Kind::none;
    const Mesh* mesh = nullptr;
    Rgb albedo;                          // of a Lambertian one that has no textures
    const Bsdf::Model* model = nullptr;  // of any of them; null: it is not the same everywhere
    const Shading* shading = nullptr;    // knows what it is where
    float least_offset = 0;              // by which rays must leave the shape, m
    const float* turned = nullptr;       // by triangle: see triangle_offset_at(); null: none is more than that
    std::uint8_t lobes = 0;              // rough ones of it: who leaves one of them out is shaded alone
    bool one_sided = false;
    bool bumpy = false;
    bool shines = false;  // emits light as well
    bool pane = false;    // of glass: light goes straight on through it
};

}  // namespace lightnet
