// A shape as Embree has it.
#pragma once

#include <cstdint>
#include <span>

#include "core/scene/data/scene_data.hpp"
#include "core/scene/geometry/quads.hpp"
#include "core/scene/surfaces/shading.hpp"

struct RTCDeviceTy;
struct RTCGeometryTy;

namespace lightnet {

/// What Embree hands back when a ray comes near a shape.
struct Form {
    const Shading* shading;
    std::uint32_t shape;
    bool holes;
    const Sphere* sphere = nullptr;          // or a mesh
    const PlacedQuadric* quadric = nullptr;  // the same
    const MovingShape* moving = nullptr;     // of what moves; null: it stands still
    const Curves* curves = nullptr;          // the same
    Quads quads{};                           // of a mesh whose triangles are paired

    /// Embree's name of a point as ours. `normal` is Embree's, of any length, and of curves alone looked at.
    TrianglePoint point(std::uint32_t primitive, Vec2 at, Vec3 normal) const {
        if (curves) return {primitive, {at.x, across(curves->at(primitive, at.x), normal)}};
        return quads.empty() ? TrianglePoint{primitive, at} : quads.point(primitive, at);
    }
    bool is_there(const TrianglePoint& point) const {
        return !holes || shading->is_there(shape, point.triangle, point.at.x, point.at.y);
    }
};

/// Pairs the triangles of all meshes of a scene, unless too few find another: Embree builds a tree of its own for
/// quads beside that for triangles, so a scene has one or the other. One form for each shape.
void pair_triangles(const SceneData& data, std::span<Form> forms);

/// Keeps looking at both, which stay where they are. Pads a mesh's positions by one element, and those of `later`: the
/// steps of what moves. To be released.
RTCGeometryTy* new_geometry(RTCDeviceTy* device, Shape& shape, Form& form, std::span<ShapeGeometry> later);

}  // namespace lightnet
