#include "core/scene/shapes/placed_quadric.hpp"

#include "core/base/math/sampling.hpp"
#include "core/scene/shapes/ball.hpp"

#include <algorithm>

namespace lightnet {
namespace {

constexpr float whole_turn = 2 * pi;

bool is_whole_turn(float turn) { return turn >= whole_turn * (1 - 1e-6f); }

float angle_from_top(float z) { return std::acos(std::clamp(z, -1.0f, 1.0f)); }

}  // namespace

PlacedQuadric::PlacedQuadric(const Quadric& quadric) : quadric_(quadric) {
    const auto& m = quadric.to_world.m;
    bool all_finite = true;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j) all_finite &= std::isfinite(float(m[i][j]));
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t r = (i + 1) % 3, s = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
            cofactors_[i][j] = m[r][c] * m[s][d] - m[r][d] * m[s][c];
        }
    const double determinant = m[0][0] * cofactors_[0][0] + m[0][1] * cofactors_[0][1] + m[0][2] * cofactors_[0][2];
    volume_ = std::fabs(determinant);
    for (const auto& row : m)
        for (std::size_t j = 0; j < 3; ++j) size_ = std::max(size_, float(std::fabs(row[j])));
    usable_ = all_finite && determinant != 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            inverse_[i][j] = cofactors_[j][i] / determinant;
            usable_ &= std::isfinite(inverse_[i][j]);
        }
    if (!is_whole_turn(quadric.turn))
        end_ = square_angle(std::cos(double{quadric.turn}), std::sin(double{quadric.turn}));
    // normals stay on their side, whatever the transform mirrors
    if (determinant < 0)
        for (auto& row : cofactors_)
            for (double& value : row) value = -value;
}

PlacedQuadric::Wide PlacedQuadric::wide_to_own(Vec3 v, bool point) const {
    const auto& m = quadric_.to_world.m;
    const double p = point ? 1 : 0, x = v.x - p * m[0][3], y = v.y - p * m[1][3], z = v.z - p * m[2][3];
    const auto row = [&](std::size_t i) { return inverse_[i][0] * x + inverse_[i][1] * y + inverse_[i][2] * z; };
    return {row(0), row(1), row(2)};
}

bool PlacedQuadric::is_part(const Wide& own) const {
    if (end_ < 4 && square_angle(own[0], own[1]) > end_) return false;
    switch (quadric_.round) {
        case Quadric::Round::disk: {
            const double r2 = own[0] * own[0] + own[1] * own[1], inner = quadric_.inner;
            return r2 <= 1 && r2 >= inner * inner;
        }
        case Quadric::Round::cylinder:
            return own[2] >= 0 && own[2] <= 1;
        case Quadric::Round::sphere:
            break;
    }
    return (quadric_.low <= -1 || own[2] >= quadric_.low) && (quadric_.high >= 1 || own[2] <= quadric_.high);
}

Vec2 PlacedQuadric::name_of(const Wide& own) const {
    const Vec3 at{float(own[0]), float(own[1]), float(own[2])};
    if (quadric_.round == Quadric::Round::disk) return {at.x, at.y};
    if (quadric_.round == Quadric::Round::sphere) return to_octahedral(normalize(at));
    return {float(square_angle(own[0], own[1]) - 2), at.z};
}

Vec2 PlacedQuadric::name_of(Vec3 own) const { return name_of(Wide{own.x, own.y, own.z}); }

Vec2 PlacedQuadric::name_near(Vec3 position) const {
    const Vec3 own = point_to_own(position);
    switch (quadric_.round) {
        case Quadric::Round::disk: {
            const float r = std::sqrt(own.x * own.x + own.y * own.y);
            const float wanted = std::clamp(r, quadric_.inner, 1.0f);
            return r > 0 ? Vec2{own.x * (wanted / r), own.y * (wanted / r)} : Vec2{wanted, 0};
        }
        case Quadric::Round::cylinder:
            return {name_of(own).x, std::clamp(own.z, 0.0f, 1.0f)};
        case Quadric::Round::sphere:
            break;
    }
    const float far = length(own);
    return far > 0 ? to_octahedral(own / far) : to_octahedral({0, 0, 1});
}

Vec3 PlacedQuadric::own_point(Vec2 name) const {
    if (quadric_.round == Quadric::Round::disk) return {name.x, name.y, 0};
    if (quadric_.round == Quadric::Round::sphere) return from_octahedral(name);
    const float quarters = name.x + 2;
    const float x = quarters <= 2 ? 1 - quarters : quarters - 3,
                y = quarters <= 2 ? 1 - std::fabs(x) : std::fabs(x) - 1;
    const float size = std::sqrt(x * x + y * y);
    return {x / size, y / size, name.y};
}

Vec3 PlacedQuadric::point_to_own(Vec3 position) const {
    const Wide own = wide_to_own(position, true);
    return {float(own[0]), float(own[1]), float(own[2])};
}
Vec3 PlacedQuadric::direction_to_own(Vec3 direction) const {
    const Wide own = wide_to_own(direction, false);
    return {float(own[0]), float(own[1]), float(own[2])};
}

Vec3 PlacedQuadric::position(Vec3 own) const { return transform_point(quadric_.to_world, own); }
Vec3 PlacedQuadric::out_of_own(Vec3 direction) const { return transform_direction(quadric_.to_world, direction); }

Vec3 PlacedQuadric::own_normal(Vec3 own) const {
    switch (quadric_.round) {
        case Quadric::Round::disk:
            return {0, 0, 1};
        case Quadric::Round::cylinder:
            return {own.x, own.y, 0};
        case Quadric::Round::sphere:
            break;
    }
    return own;
}

Vec3 PlacedQuadric::normal(Vec3 own) const {
    const Vec3 n = own_normal(own);
    const auto row = [&](std::size_t i) {
        return cofactors_[i][0] * n.x + cofactors_[i][1] * n.y + cofactors_[i][2] * n.z;
    };
    const double x = row(0), y = row(1), z = row(2), size = std::sqrt(x * x + y * y + z * z);
    const double sign = quadric_.flip_normals ? -1 : 1;
    return {float(sign * x / size), float(sign * y / size), float(sign * z / size)};
}

// Its points are rounded along their radius. What rays round is far less, as they are met in double.
float PlacedQuadric::own_offset(Vec3 own, Vec3 normal) const {
    const bool flat = quadric_.round == Quadric::Round::disk;
    const float radius = flat ? 0 : std::fabs(dot(out_of_own(own_normal(own)), normal));
    return ball_offset(radius) + rounding_step * size_;
}

float PlacedQuadric::stretch(Vec3 own) const {
    const Vec3 n = own_normal(own);
    double sum = 0;
    for (const auto& row : cofactors_) {
        const double value = row[0] * n.x + row[1] * n.y + row[2] * n.z;
        sum += value * value;
    }
    return float(std::sqrt(sum));
}

Vec2 PlacedQuadric::uv(Vec3 own) const {
    float angle = std::atan2(own.y, own.x);
    if (angle < 0) angle += whole_turn;
    const float a = angle / quadric_.turn;
    float b = own.z;  // of a cylinder
    if (quadric_.round == Quadric::Round::disk) {
        b = (1 - std::sqrt(own.x * own.x + own.y * own.y)) / (1 - quadric_.inner);
    } else if (quadric_.round == Quadric::Round::sphere) {
        const float bottom = angle_from_top(quadric_.low);
        b = (bottom - angle_from_top(own.z)) / (bottom - angle_from_top(quadric_.high));
    }
    const auto row = [&](const std::array<float, 3>& factors) { return factors[0] * a + factors[1] * b + factors[2]; };
    return {row(quadric_.to_uv[0]), row(quadric_.to_uv[1])};
}

PlacedQuadric::Along PlacedQuadric::along(Vec3 own) const {
    const float width = std::sqrt(own.x * own.x + own.y * own.y);
    const Vec3 outwards = width > 0 ? Vec3{own.x / width, own.y / width, 0} : Vec3{1, 0, 0};
    const Vec3 a = out_of_own(Vec3{-own.y, own.x, 0} * quadric_.turn);
    Vec3 up{0, 0, 1};
    if (quadric_.round == Quadric::Round::disk)
        up = outwards * (quadric_.inner - 1);
    else if (quadric_.round == Quadric::Round::sphere)
        up = (Vec3{0, 0, width} - outwards * own.z) * (angle_from_top(quadric_.low) - angle_from_top(quadric_.high));
    const Vec3 b = out_of_own(up);
    const auto& [u, v] = quadric_.to_uv;
    const float determinant = u[0] * v[1] - u[1] * v[0];
    return {(a * v[1] - b * v[0]) / determinant, (b * u[0] - a * u[1]) / determinant};
}

bool PlacedQuadric::whole() const {
    const bool all =
        quadric_.round == Quadric::Round::sphere ? quadric_.low <= -1 && quadric_.high >= 1 : quadric_.inner <= 0;
    return all && end_ >= 4;
}

float PlacedQuadric::own_area() const {
    switch (quadric_.round) {
        case Quadric::Round::disk:
            return 0.5f * quadric_.turn * (1 - quadric_.inner * quadric_.inner);
        case Quadric::Round::cylinder:
            return quadric_.turn;
        case Quadric::Round::sphere:
            break;
    }
    return quadric_.turn * (quadric_.high - quadric_.low);
}

float PlacedQuadric::area() const {
    constexpr int cells = 64;  // along each side: the stretch is smooth
    if (quadric_.round == Quadric::Round::disk) return own_area() * stretch({});
    double sum = 0;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
            sum += double{stretch(own_uniform({(float(i) + 0.5f) / cells, (float(j) + 0.5f) / cells}))};
    return own_area() * float(sum / (cells * cells));
}

Vec3 PlacedQuadric::own_uniform(Vec2 u) const {
    if (quadric_.round == Quadric::Round::disk && whole()) {
        const Vec2 at = disk(u);
        return {at.x, at.y, 0};
    }
    if (quadric_.round == Quadric::Round::sphere && whole()) return sphere(u);
    const float angle = u.x * quadric_.turn, c = std::cos(angle), s = std::sin(angle);
    if (quadric_.round == Quadric::Round::cylinder) return {c, s, u.y};
    if (quadric_.round == Quadric::Round::disk) {
        const float inner2 = quadric_.inner * quadric_.inner, r = std::sqrt(inner2 + u.y * (1 - inner2));
        return {r * c, r * s, 0};
    }
    const float z = quadric_.low + u.y * (quadric_.high - quadric_.low), r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * c, r * s, z};
}

Box PlacedQuadric::bounds() const {
    const auto& m = quadric_.to_world.m;
    Box box;
    Vec3 low, high;
    double pad = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double across = std::hypot(m[i][0], m[i][1]);
        double middle = m[i][3], reach = across;
        if (quadric_.round == Quadric::Round::cylinder) middle += 0.5 * m[i][2], reach += 0.5 * std::fabs(m[i][2]);
        if (quadric_.round == Quadric::Round::sphere) reach = std::hypot(across, m[i][2]);
        pad = std::max(pad, 1e-6 * (reach + std::fabs(middle)));
        low[i] = float(middle - reach), high[i] = float(middle + reach);
    }
    const float all = float(pad);  // along flat sides, too
    box.add(low - Vec3{all, all, all}), box.add(high + Vec3{all, all, all});
    return box;
}

}  // namespace lightnet
