// All shapes there are, and what every one of them must be able to say.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "core/base/math/box.hpp"
#include "core/base/math/transform.hpp"
#include "core/scene/shapes/curves.hpp"
#include "core/scene/shapes/mesh.hpp"
#include "core/scene/shapes/placed_quadric.hpp"
#include "core/scene/shapes/quadric.hpp"
#include "core/scene/shapes/sphere.hpp"

namespace lightnet {

/// The list. A new one goes to its end: the number of a shape in it is part of a scene's identity. What else there is
/// to say of a shape stands where it is used, as overloads of one function without a catch-all, so that a shape that
/// was forgotten there does not compile.
using ShapeGeometry = std::variant<Mesh, Sphere, Quadric, Curves>;

/// What every shape of the list is, beside a list of its own members.
///   names: what several are called in words
///   part: what of it may lie too far away, in words
///   pieces(): how many there are that a question may name (Query::primitive)
///   fault(): why it can't be built; "": it can
///   add_to(): grows a box around it, once it is moved
///   extent(): its largest coordinate, or more (metres); not finite where one of them isn't
///   largest_piece(): the longest side of its flat pieces, or more (metres); 0: it has none
///   area(): m²
///   memory(): bytes
///   placed(): how its points are found: it itself, or what is worked out once from it; looks at it
template <class S>
concept IsShape = requires(S& shape, const S& constant, Box& box, const Matrix& to_world) {
    { S::names } -> std::convertible_to<const char*>;
    { S::part } -> std::convertible_to<const char*>;
    { constant.pieces() } -> std::same_as<std::uint64_t>;
    { constant.fault() } -> std::same_as<std::string>;
    constant.add_to(box, to_world);
    { constant.extent() } -> std::same_as<float>;
    { constant.largest_piece() } -> std::same_as<float>;
    { constant.area() } -> std::same_as<double>;
    { constant.memory() } -> std::same_as<std::size_t>;
    constant.placed();
    visit_members(shape, [](auto&...) {});
};

template <class Shapes>
struct PlacedOf;
template <class... Shapes>
struct PlacedOf<std::variant<Shapes...>> {
    static_assert((IsShape<Shapes> && ...), "a shape must say what IsShape asks");
    using type = std::variant<decltype(std::declval<const Shapes&>().placed())...>;
};
/// A shape as points on it are found.
using PlacedShape = PlacedOf<ShapeGeometry>::type;

inline PlacedShape placed(const ShapeGeometry& shape) {
    return std::visit([](const auto& one) { return PlacedShape(one.placed()); }, shape);
}
inline std::uint64_t pieces_of(const ShapeGeometry& shape) {
    return std::visit([](const auto& one) { return one.pieces(); }, shape);
}
inline double area_of(const ShapeGeometry& shape) {
    return std::visit([](const auto& one) { return one.area(); }, shape);
}
inline void add_to(Box& box, const ShapeGeometry& shape, const Matrix& to_world) {
    std::visit([&](const auto& one) { one.add_to(box, to_world); }, shape);
}
inline std::size_t memory_of(const ShapeGeometry& shape) {
    return std::visit([](const auto& one) { return one.memory(); }, shape);
}

}  // namespace lightnet
