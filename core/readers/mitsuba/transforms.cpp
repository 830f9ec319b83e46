#include "core/readers/mitsuba/transforms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/readers/common/between_transforms.hpp"

namespace lightnet::mitsuba {
namespace {

Matrix diagonal(double x, double y, double z) {
    Matrix t;
    t.m[0][0] = x, t.m[1][1] = y, t.m[2][2] = z;
    return t;
}

Matrix translation(Vec3 by) {
    Matrix t;
    for (std::size_t i = 0; i < 3; ++i) t.m[i][3] = by[i];
    return t;
}

/// Rodrigues' formula; `axis` is unit.
Matrix rotation(Vec3 axis, double degrees) {
    const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
    Matrix t;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t k = 3 - i - j;
            const double sign = (j + 1) % 3 == i ? 1 : -1;
            t.m[i][j] = double(axis[i]) * axis[j] * (1 - c) + (i == j ? c : sign * axis[k % 3] * s);
        }
    return t;
}

std::optional<Matrix> rotate(const Node& node, const Context& context) {
    const auto axis = triple(node, context, 0);
    const auto angle = number(node.attribute("angle"), node, context);
    if (!axis || !angle) return std::nullopt;
    if (length(*axis) > 0) return rotation(normalize(*axis), *angle);
    context.error(node, "a rotation needs an axis");
    return std::nullopt;
}

std::optional<Vec3> attribute_point(const Node& node, std::string_view key, Vec3 fallback, const Context& context) {
    if (!node.has(key)) return fallback;
    const auto values = numbers(node.attribute(key), node, context);
    if (values && values->size() == 3) return Vec3{float((*values)[0]), float((*values)[1]), float((*values)[2])};
    if (values) context.error(node, fmt::format("'{}' needs three numbers", key));
    return std::nullopt;
}

/// Looks along +z, with x to the left.
std::optional<Matrix> look_at(const Node& node, const Context& context) {
    const auto origin = attribute_point(node, "origin", {0, 0, 0}, context);
    const auto target = attribute_point(node, "target", {0, 0, 1}, context);
    const auto up = attribute_point(node, "up", {0, 1, 0}, context);
    if (!origin || !target || !up) return std::nullopt;
    const Vec3 ahead = *target - *origin, left = cross(*up, ahead);
    if (length(ahead) == 0 || length(left) == 0) {
        context.error(node, "lookat: origin, target and up span no view");
        return std::nullopt;
    }
    const Vec3 z = normalize(ahead), x = normalize(left), y = cross(z, x);
    Matrix t = translation(*origin);
    for (std::size_t i = 0; i < 3; ++i) t.m[i][0] = x[i], t.m[i][1] = y[i], t.m[i][2] = z[i];
    return t;
}

std::optional<Matrix> matrix(const Node& node, const Context& context) {
    const auto values = numbers(node.attribute("value"), node, context);
    if (!values) return std::nullopt;
    const std::size_t side = values->size() == 16 ? 4 : 3;
    if (values->size() != side * side) {
        context.error(node, fmt::format("a matrix has 16 numbers, not {}", values->size()));
        return std::nullopt;
    }
    Matrix t;
    for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; j < side; ++j) t.m[i][j] = (*values)[i * side + j];
    return t;
}

std::optional<Matrix> statement(const Node& node, const Context& context) {
    if (node.tag == "rotate") return rotate(node, context);
    if (node.tag == "lookat") return look_at(node, context);
    if (node.tag == "matrix") return matrix(node, context);
    const bool scaling = node.tag == "scale";
    const auto values = triple(node, context, scaling ? 1 : 0);
    if (!values) return std::nullopt;
    return scaling ? diagonal(values->x, values->y, values->z) : translation(*values);
}

/// The keys of an <animation>. None: reported.
std::vector<TransformKey> keys_of(const Node& node, const Context& context) {
    std::vector<TransformKey> keys;
    for (const auto& child : node.children) {
        const auto seconds = number(child->attribute("time"), *child, context);
        if (!seconds) return {};
        if (!std::isfinite(*seconds)) {
            context.error(*child, "the time of a key is a number of seconds");
            return {};
        }
        if (!keys.empty() && !(*seconds > keys.back().seconds)) {
            context.error(*child, "the times of an animation follow each other");
            return {};
        }
        keys.push_back({*seconds, transform_of(*child, context)});
    }
    return keys;
}

Matrix animated(const Node& node, const Context& context) {
    const auto keys = keys_of(node, context);
    if (keys.empty()) return {};
    auto& known = context.assets.scene().animations;
    if (known.empty()) known.emplace_back();
    known.front().seconds = std::max(known.front().seconds, keys.back().seconds);
    if (context.seconds) return transform_at(keys, *context.seconds);
    context.warn(node,
                 "animated transforms are taken as they stand at first (--frames, or the scene's 'time', chooses "
                 "another moment)");
    return keys.front().transform;
}

}  // namespace

Matrix transform_of(const Node& node, const Context& context) {
    if (node.tag == "animation") return animated(node, context);
    Matrix whole;
    for (const auto& child : node.children) {
        const auto& tag = child->tag;
        if (tag != "translate" && tag != "scale" && tag != "rotate" && tag != "lookat" && tag != "matrix")
            context.error(*child, fmt::format("unknown transform <{}>", tag));
        else if (const auto next = statement(*child, context))
            whole = *next * whole;
    }
    return whole;
}

Matrix transform_of(Properties& properties, std::string_view name) {
    const Node* given = properties.find(name);
    return given ? transform_of(*given, properties.context()) : Matrix{};
}

UvTransform uv_transform(Properties& properties, bool flipped) {
    Matrix t = transform_of(properties, "to_uv");
    // of 0.6; a 3×3 matrix has its offsets in the third column
    const Matrix older = [&] {
        Matrix m = diagonal(properties.number("uscale", 1), properties.number("vscale", 1), 1);
        m.m[0][3] = properties.number("uoffset", 0), m.m[1][3] = properties.number("voffset", 0);
        return m;
    }();
    t = older * t;
    double a = t.m[0][0], b = t.m[0][1], c = t.m[1][0], d = t.m[1][1];
    double u = t.m[0][3] + t.m[0][2], v = t.m[1][3] + t.m[1][2];
    u += b, v += d, b = -b, d = -d;  // Mitsuba's v is 1 - ours
    if (!flipped) c = -c, d = -d, v = 1 - v;
    // (a b; c d) = turn · scale, where it is
    UvTransform result;
    result.scale = {float(std::hypot(a, c)), float(std::hypot(b, d))};
    result.offset = {float(u), float(v)};
    result.turn = float(std::atan2(c, a));
    if (a * d - b * c < 0) result.scale.y = -result.scale.y;
    if (std::fabs(a * b + c * d) > 1e-4 * (std::fabs(a * d) + std::fabs(b * c)))
        properties.context().warn(properties.node(),
                                  "the shear of a to_uv transform is left out: textures lie straight");
    return result;
}

std::optional<float> uniform_scale(const Matrix& t) {
    double length[3];
    for (std::size_t j = 0; j < 3; ++j) length[j] = std::hypot(t.m[0][j], t.m[1][j], t.m[2][j]);
    for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3;
        const double product = t.m[0][a] * t.m[0][b] + t.m[1][a] * t.m[1][b] + t.m[2][a] * t.m[2][b];
        if (std::fabs(length[a] - length[b]) > 1e-4 * length[0] || std::fabs(product) > 1e-4 * length[a] * length[b])
            return std::nullopt;
    }
    return static_cast<float>(length[0]);
}

}  // namespace lightnet::mitsuba
