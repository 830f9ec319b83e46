#include "tools/explain/path_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "core/scene/camera/camera.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t least_side = 900;  // pixels of the longer side, so that lines can be told apart
constexpr float ground = 0.35f;            // times which the picture shows behind the lines
constexpr float sky_reach = 0.3f;          // radii of the scene, of rays that meet nothing

// What lies behind the eye is cut off, or it would appear mirrored. `from`, `to`: homogeneous positions in the picture.
// None: all of it does.
std::optional<std::pair<Vec2, Vec2>> in_front(Vec3 from, Vec3 to) {
    constexpr float nearest = 1e-4f;
    if (from.z < nearest && to.z < nearest) return std::nullopt;
    const auto cut = [&](Vec3 outside, Vec3 inside) {
        const float part = (nearest - outside.z) / (inside.z - outside.z);
        return outside + (inside - outside) * part;
    };
    if (from.z < nearest) from = cut(from, to);
    if (to.z < nearest) to = cut(to, from);
    return std::pair(Vec2{from.x / from.z, from.y / from.z}, Vec2{to.x / to.z, to.y / to.z});
}

class Drawing {
public:
    explicit Drawing(const Picture& under) : x_(under.x), y_(under.y) {
        enlarged_ = std::max(1u, least_side / std::max(under.width, under.height));
        drawn_.width = under.width * enlarged_, drawn_.height = under.height * enlarged_;
        drawn_.beauty.reserve(std::size_t{drawn_.width} * drawn_.height);
        for (std::uint32_t y = 0; y < drawn_.height; ++y)
            for (std::uint32_t x = 0; x < drawn_.width; ++x) {
                const Rgb pixel = under.beauty[std::size_t{y / enlarged_} * under.width + x / enlarged_];
                drawn_.beauty.push_back({std::min(pixel.r, 1.0f) * ground, std::min(pixel.g, 1.0f) * ground,
                                         std::min(pixel.b, 1.0f) * ground});
            }
    }

    void line(Vec2 from, Vec2 to, Rgb colour) { draw_flat(place(from), place(to), colour); }

    void frame(std::uint32_t x, std::uint32_t y, Rgb colour) {
        const float left = float(x) - 0.5f, top = float(y) - 0.5f, right = left + 2, bottom = top + 2;
        const std::array<Vec2, 5> corners{{{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}}};
        for (std::size_t i = 0; i + 1 < corners.size(); ++i) line(corners[i], corners[i + 1], colour);
    }

    Picture take() { return std::move(drawn_); }

private:
    Vec2 place(Vec2 seen) const {
        return {(seen.x - float(x_)) * float(enlarged_), (seen.y - float(y_)) * float(enlarged_)};
    }

    // Cuts the line at the border (Liang and Barsky 1984), and sets a pixel for each step of at most one.
    void draw_flat(Vec2 from, Vec2 to, Rgb colour) {
        float first = 0, last = 1;
        const auto keep = [&](float step, float room) {
            if (step == 0) return room >= 0;
            const float at = room / step;
            if (step < 0)
                first = std::max(first, at);
            else
                last = std::min(last, at);
            return first <= last;
        };
        const float dx = to.x - from.x, dy = to.y - from.y, right = float(drawn_.width - 1),
                    low = float(drawn_.height - 1);
        if (!keep(-dx, from.x) || !keep(dx, right - from.x) || !keep(-dy, from.y) || !keep(dy, low - from.y)) return;
        const int steps = std::max(1, int(std::ceil(std::max(std::fabs(dx), std::fabs(dy)) * (last - first))));
        for (int i = 0; i <= steps; ++i) {
            const float t = first + (last - first) * float(i) / float(steps);
            const auto x = std::size_t(std::clamp(from.x + t * dx, 0.0f, right)),
                       y = std::size_t(std::clamp(from.y + t * dy, 0.0f, low));
            drawn_.beauty[y * drawn_.width + x] = colour;
        }
    }

    std::uint32_t x_, y_, enlarged_ = 1;
    Picture drawn_;
};

Vec3 end_of(const TracedRay& ray, const Scene& scene) {
    if (ray.hit) return scene.surface(*ray.hit).position;
    const float ends = ray.ray.far < std::numeric_limits<float>::max() ? ray.ray.far : scene.radius() * sky_reach;
    return ray.ray.origin + ray.ray.direction * ends;
}

}  // namespace

PathColour path_colour(std::size_t node) {
    constexpr std::array<PathColour, 6> colours{{{"yellow", {1, 0.8f, 0}},
                                                 {"cyan", {0, 0.8f, 1}},
                                                 {"magenta", {1, 0.1f, 0.7f}},
                                                 {"green", {0.1f, 0.9f, 0.1f}},
                                                 {"orange", {1, 0.3f, 0}},
                                                 {"blue", {0.15f, 0.2f, 1}}}};
    return colours[node % colours.size()];
}

std::vector<PathLine> path_lines(const PixelAccount& account, std::size_t most) {
    const Scene& scene = *account.network->scene;
    std::vector<PathLine> lines;
    for (std::size_t i = std::min(most, account.parts.size()); i-- > 0;) {
        const auto& [rays, questions] = std::tie(account.parts[i].account.rays, account.parts[i].account.questions);
        for (const auto& ray : rays)
            if (const auto seen =
                    in_front(scene.camera().project(ray.ray.origin), scene.camera().project(end_of(ray, scene))))
                lines.push_back(
                    {seen->first, seen->second,
                     ray.within == AskedQuestion::nobody ? AskedQuestion::nobody : questions[ray.within].asked,
                     ray.hidden});
    }
    return lines;
}

Picture path_picture(const Picture& picture, const PixelAccount& account, std::size_t most) {
    Drawing drawing(picture);
    for (const auto& line : path_lines(account, most)) {
        Rgb colour = line.node == AskedQuestion::nobody ? Rgb{1, 1, 1} : path_colour(line.node).colour;
        if (line.hidden) colour *= 0.15f;
        drawing.line(line.from, line.to, colour);
    }
    drawing.frame(account.x, account.y, {1, 0.02f, 0.02f});
    return drawing.take();
}

}  // namespace lightnet
