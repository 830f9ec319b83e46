#include "core/readers/shutter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/math/box.hpp"
#include "core/readers/moment_of.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_parts = 32;
constexpr double allowed = 1e-3;  // of the size of a thing
constexpr double allowed_of_view = 2e-4;

double size_of(const ShapeGeometry& shape) {
    Box box;
    add_to(box, shape, Matrix{});
    return box.empty() ? 0 : double{length(box.size())};
}

double distance(const Matrix& a, const Matrix& b, double size) {
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            most = std::max(most, std::fabs(a.m[i][j] - b.m[i][j]) * (j < 3 ? size : 1));
    return most;
}

Matrix middle(const Matrix& a, const Matrix& b) {
    Matrix m;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) m.m[i][j] = (a.m[i][j] + b.m[i][j]) / 2;
    return m;
}

double off(Vec3 a, Vec3 b, Vec3 there) { return double{length((a + b) * 0.5f - there)}; }

// How far a thing is, half-way, from the middle of its straight way.
double off(const Mesh& a, const Mesh& b, const Mesh& there) {
    double most = 0;
    for (std::size_t i = 0; i < there.positions.size(); ++i)
        most = std::max(most, off(a.positions[i], b.positions[i], there.positions[i]));
    return most;
}
double off(const Sphere& a, const Sphere& b, const Sphere& there) {
    return std::max(off(a.center, b.center, there.center),
                    std::fabs((double{a.radius} + double{b.radius}) / 2 - double{there.radius}));
}
double off(const Quadric& a, const Quadric& b, const Quadric& there) {
    return distance(middle(a.to_world, b.to_world), there.to_world, 1);
}
double off(const Curves&, const Curves&, const Curves&) { return 0; }  // they stand still
bool straight(const ShapeGeometry& a, const ShapeGeometry& b, const ShapeGeometry& there, double size) {
    return std::visit(
        [&](const auto& one) {
            using Kind = std::decay_t<decltype(one)>;
            return off(one, std::get<Kind>(b), std::get<Kind>(there)) <= allowed * size;
        },
        a);
}
bool straight(const Matrix& a, const Matrix& b, const Matrix& there, double size) {
    double scale = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) scale = std::max(scale, std::fabs(there.m[i][j]));
    return distance(middle(a, b), there, size) <= allowed * size * scale;
}
template <IsNear L>
bool straight(const L& a, const L& b, const L& there) {
    return off(a.position, b.position, there.position) <= 1e-2 * double{length(b.position - a.position)} + 1e-9 &&
           off(a.aim(), b.aim(), there.aim()) <= allowed;
}
bool straight(const BareLight& a, const BareLight& b, const BareLight& there) {
    return std::visit(
        [&]<IsLight L>(const L& one) {
            if constexpr (IsNear<L>) return straight(one, std::get<L>(b), std::get<L>(there));
            return true;
        },
        a);
}

/// Reads moments, and sets what moves beside what it was at first.
// DECISIONS: blur-is-in-the-question
class ShutterReader {
public:
    ShutterReader(const std::function<SceneData(double)>& read_at, const ShutterSpan& shutter, const std::string& file)
        : read_at_(read_at), shutter_(shutter), file_(file), scene_(read_at(shutter.open)) {}

    bool holds_animations() const { return !scene_.animations.empty(); }
    /// As it is at first, where nothing moves.
    SceneData still() { return std::move(scene_); }
    SceneData read() {
        if (!(shutter_.close > shutter_.open)) return still();
        for (const auto& object : scene_.objects) {
            double most = 0;
            for (const auto shape : object.shapes) most = std::max(most, size_of(scene_.shapes[shape].geometry));
            object_sizes_.push_back(most);
        }
        std::vector<Moment> later;
        later.push_back(moment(1));
        while (later.size() < most_parts) {
            std::vector<Moment> middles;
            const std::size_t parts = later.size();
            for (std::size_t i = 0; i < parts; ++i) middles.push_back(moment((double(i) + 0.5) / double(parts)));
            bool straight_on = true;
            for (std::size_t i = 0; i < parts; ++i)
                straight_on &= straight_way(i == 0 ? nullptr : &later[i - 1], later[i], middles[i]);
            if (straight_on) break;
            std::vector<Moment> both;
            for (std::size_t i = 0; i < parts; ++i) {
                both.push_back(std::move(middles[i]));
                both.push_back(std::move(later[i]));
            }
            later = std::move(both);
        }
        set(later);
        return std::move(scene_);
    }

private:
    Moment moment(double part) {
        Moment moment = moment_of(read_at_(shutter_.open + part * (shutter_.close - shutter_.open)), scene_);
        if (moment.has_other_things)
            warn({file_, 0}, "it has other parts while the shutter is open: all but its camera stands still");
        if (moment.looks_otherwise)
            warn({file_, 0}, "colours, brightness or suns change while the shutter is open: they are as when it opens");
        for (const auto i : moment.other_shapes) {
            broken_.insert(i);
            warn(scene_.shapes[i].where, "a shape has other parts while the shutter is open: it stands still");
        }
        return moment;
    }
    void warn(const SourceLine& where, const std::string& what) {
        const Problem problem{where, what};
        if (std::ranges::find(scene_.warnings, problem) == scene_.warnings.end()) scene_.warnings.push_back(problem);
    }
    CameraData& camera(std::size_t i) { return i == 0 ? scene_.camera : scene_.cameras[i - 1].camera; }

    template <class State>
    static const State& at(const std::map<std::uint32_t, State>* there, std::uint32_t i, const State& first) {
        if (!there) return first;
        const auto found = there->find(i);
        return found == there->end() ? first : found->second;
    }
    bool straight_way(const Moment* before, const Moment& after, const Moment& half) {
        std::set<std::uint32_t> shapes, instances, lights;
        const auto note = [](const auto& states, auto& to) {
            for (const auto& [i, state] : states) to.insert(i);
        };
        for (const Moment* one : {before, &after, &half})
            if (one) note(one->shapes, shapes), note(one->instances, instances), note(one->lights, lights);
        const auto shape = [&](std::uint32_t i) {
            const auto& first = scene_.shapes[i].geometry;
            return broken_.contains(i) ||
                   straight(at(before ? &before->shapes : nullptr, i, first), at(&after.shapes, i, first),
                            at(&half.shapes, i, first), size_of(first));
        };
        const auto instance = [&](std::uint32_t i) {
            const auto& first = scene_.instances[i].to_world;
            return straight(at(before ? &before->instances : nullptr, i, first), at(&after.instances, i, first),
                            at(&half.instances, i, first), object_sizes_[scene_.instances[i].object]);
        };
        const auto light = [&](std::uint32_t i) {
            const auto& first = scene_.lights[i];
            return straight(at(before ? &before->lights : nullptr, i, first), at(&after.lights, i, first),
                            at(&half.lights, i, first));
        };
        return std::ranges::all_of(shapes, shape) && std::ranges::all_of(instances, instance) &&
               std::ranges::all_of(lights, light) && straight_view(before, after, half);
    }
    bool straight_view(const Moment* before, const Moment& after, const Moment& half) {
        for (std::size_t c = 0; c < half.cameras.size() && c < after.cameras.size(); ++c) {
            const CameraData& first = before && c < before->cameras.size() ? before->cameras[c] : camera(c);
            const Matrix way = middle(first.to_world, after.cameras[c].to_world);
            double turned = 0, moved = 0, travelled = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 3; ++j)
                    turned = std::max(turned, std::fabs(way.m[i][j] - half.cameras[c].to_world.m[i][j]));
                moved = std::max(moved, std::fabs(way.m[i][3] - half.cameras[c].to_world.m[i][3]));
                travelled = std::max(travelled, std::fabs(first.to_world.m[i][3] - after.cameras[c].to_world.m[i][3]));
            }
            if (turned > allowed_of_view || moved > 1e-2 * travelled + 1e-9) return false;
        }
        return true;
    }

    template <class State, class First>
    static std::vector<Moved<State>> moved(const std::vector<Moment>& later, std::map<std::uint32_t, State> Moment::*of,
                                           const std::set<std::uint32_t>& not_these, const First& first) {
        std::set<std::uint32_t> which;
        for (const Moment& moment : later)
            for (const auto& [i, state] : moment.*of)
                if (!not_these.contains(i)) which.insert(i);
        std::vector<Moved<State>> all;
        for (const std::uint32_t i : which) {
            Moved<State> one{i, {}};
            for (const Moment& moment : later) one.later.push_back(at(&(moment.*of), i, first(i)));
            all.push_back(std::move(one));
        }
        return all;
    }
    void set(const std::vector<Moment>& later) {
        SceneMotion& motion = scene_.motion;
        motion.shapes = moved(later, &Moment::shapes, broken_,
                              [&](std::uint32_t i) { return positions_of(scene_.shapes[i].geometry); });
        motion.instances =
            moved(later, &Moment::instances, {}, [&](std::uint32_t i) { return scene_.instances[i].to_world; });
        motion.lights = moved(later, &Moment::lights, {}, [&](std::uint32_t i) { return scene_.lights[i]; });
        for (std::size_t c = 0; c < later.back().cameras.size(); ++c) {
            CameraData& first = camera(c);
            const bool moves = std::ranges::any_of(later, [&](const Moment& moment) {
                return moment.cameras.size() > c &&
                       (moment.cameras[c].to_world.m != first.to_world.m || moment.cameras[c].fov != first.fov);
            });
            for (const Moment& moment : later)
                if (moves && moment.cameras.size() > c) first.later.push_back(moment.cameras[c]);
        }
    }

    const std::function<SceneData(double)>& read_at_;
    const ShutterSpan shutter_;
    const std::string& file_;
    SceneData scene_;
    std::vector<double> object_sizes_;
    std::set<std::uint32_t> broken_;  // shapes that have other parts at times
};

}  // namespace

SceneData read_in_shutter(const std::function<SceneData(double seconds)>& read_at, const ShutterSpan& shutter,
                          const std::string& file) {
    ShutterReader reader(read_at, shutter, file);
    return reader.holds_animations() ? reader.read() : reader.still();
}

SceneData blurred_between(const FramesAround& frames, const ShutterSpan& shutter, const std::string& file) {
    std::optional<Moment> before, after;
    if (frames.previous) before = moment_of(*frames.previous, frames.now);
    if (frames.next) after = moment_of(*frames.next, frames.now);
    const std::function<SceneData(double)> at = [&](double frame) {
        const auto& there = frame < 0 ? before : after;
        return there ? on_the_way(frames.now, *there, std::fabs(frame)) : frames.now;
    };
    SceneData scene = ShutterReader(at, shutter, file).read();
    for (const auto* there : {&before, &after}) {
        if (!*there) continue;
        if ((*there)->has_other_things)
            scene.warnings.push_back(
                {{file, 0}, "the frame beside it has other parts: all but its camera stands still"});
        for (const auto i : (*there)->other_shapes)
            scene.warnings.push_back(
                {scene.shapes[i].where, "a shape has other parts in the frame beside it: it stands still"});
    }
    return scene;
}

}  // namespace lightnet
