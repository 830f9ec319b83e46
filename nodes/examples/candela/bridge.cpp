// Introduces the library Candela, which stays as it is, to lightnet: once for all of its classes, then a line for each.
#include "core/network/light/wrap.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/surface_lookup.hpp"
#include "nodes/examples/candela/candela.hpp"
#include "nodes/examples/candela/candela_kinds.hpp"

namespace lightnet {
namespace {

candela::Vec theirs(Vec3 v) { return {v.x, v.y, v.z}; }
candela::Colour theirs(Rgb c) { return {c.r, c.g, c.b}; }
Vec3 ours(const candela::Vec& v) { return {float(v.x), float(v.y), float(v.z)}; }
Rgb ours(const candela::Colour& c) { return {float(c.red), float(c.green), float(c.blue)}; }

/// `outgoing` leads to where it is seen from.
candela::Spot spot_of(const Scene& scene, const SurfacePoint& point, Vec3 outgoing) {
    const Bsdf bsdf = scene.bsdf(point);
    const Vec3 normal = dot(point.shading.z, outgoing) < 0 ? -point.shading.z : point.shading.z;
    candela::Spot spot;
    spot.where = theirs(point.position);
    spot.normal = theirs(normal);
    spot.paint = theirs(bsdf.evaluate(normal, normal, lobe::rough) * pi);
    if (const auto mirrored = bsdf.sample(outgoing, 0, {}, lobe::specular))
        if (dot(mirrored->incoming, normal) > 0) spot.gloss = theirs(mirrored->weight);
    spot.shine = theirs(scene.lights().emission(point, outgoing));
    return spot;
}

/// The library's view of a scene.
class World final : public candela::Tracer, public candela::Lamps {
public:
    World(const Scene& scene, SurfaceLookup& lookup) : scene_(scene), lookup_(lookup) {}

    bool nearest(const candela::Vec& from, const candela::Vec& towards, candela::Spot& spot) override {
        const Vec3 direction = normalize(ours(towards));
        const auto hit = scene_.intersect(Ray{lookup_.origin(ours(from), direction), direction});
        if (hit) spot = spot_of(scene_, lookup_.point(*hit), -direction);
        return hit.has_value();
    }
    bool blocked(const candela::Vec& from, const candela::Vec& to) override {
        const Vec3 direction = normalize(ours(to) - ours(from));
        return scene_.occluded(ray_between(lookup_.origin(ours(from), direction), ours(to), direction));
    }
    candela::Colour sky(const candela::Vec& from, const candela::Vec& towards) override {
        const Vec3 direction = ours(towards);
        const auto sun = scene_.lights().sun(direction);
        const Rgb around = scene_.lights().environment({ours(from), direction});
        return theirs(sun ? around + sun->light.radiance : around);
    }

    bool choose(const candela::Vec& from, const double (&numbers)[3], candela::LampPoint& point) override {
        const auto lamp =
            scene_.lights().sample(LitPoint(ours(from)), float(numbers[0]), {float(numbers[1]), float(numbers[2])});
        if (lamp) point = {theirs(lamp->position), theirs(lamp->direction), theirs(lamp->radiance), lamp->pdf};
        return lamp.has_value();
    }

private:
    const Scene& scene_;
    SurfaceLookup& lookup_;
};

/// An input of the node, as the library knows it: asked about one spot at a time.
class InputGlow final : public candela::Glow {
public:
    InputGlow(OneByOne& inputs, const SurfaceLookup& lookup) : inputs_(inputs), lookup_(lookup) {}
    candela::Colour glow(const candela::Spot& spot, const candela::Vec& towards_eye) override {
        const Vec3 outgoing = normalize(ours(towards_eye));
        return theirs(inputs_.ask(0, lookup_.question(ours(spot.where), ours(spot.normal), outgoing)));
    }

private:
    OneByOne& inputs_;
    const SurfaceLookup& lookup_;
};

/// What an instance of any of its classes finds around it.
struct CandelaWorld {
    CandelaWorld(const NodeContext& here, OneByOne& inputs)
        : lookup(here.scene()), world(here.scene(), lookup), input(inputs, lookup) {}
    SurfaceLookup lookup;
    World world;
    InputGlow input;
    candela::Dice dice;
};

}  // namespace

/// All classes of the library that glow.
template <std::derived_from<candela::Glow> T>
struct Bridge<T> {
    Bridge(const NodeContext& here, OneByOne& inputs, const auto& make)
        : scene_(here.scene()), inputs_(inputs), around_(here, inputs), instance_(make(around_)) {}

    Rgb light(const Query& question) {
        around_.lookup.forget();
        if constexpr (std::same_as<T, candela::OpenGlow>)
            candela::seed_chance(inputs_.seed());
        else
            around_.dice.seed(inputs_.seed());
        const candela::Spot spot = spot_of(scene_, around_.lookup.point(question), question.outgoing);
        return ours(instance_.glow(spot, theirs(question.outgoing)));
    }

private:
    const Scene& scene_;
    OneByOne& inputs_;
    CandelaWorld around_;
    T instance_;
};

/// And those that see.
template <class T>
requires requires(T& eye, candela::Vec vec) { eye.see(vec, vec); }
struct Bridge<T> {
    Bridge(const NodeContext& here, OneByOne& inputs, const auto& make)
        : scene_(here.scene()), around_(here, inputs), instance_(make(around_)) {}

    Rgb sample(const PixelSample& at) {
        around_.lookup.forget();
        const Ray ray = scene_.camera().ray(at.x, at.y);
        return ours(instance_.see(theirs(ray.origin), theirs(ray.direction)));
    }

private:
    const Scene& scene_;
    CandelaWorld around_;
    T instance_;
};

std::vector<Kind> candela_kinds() {
    using Around = CandelaWorld;
    std::vector<Kind> kinds{
        wrap<candela::DirectGlow>(
            "CandelaDirect", {.help = "wrapped example: light straight from lamps, on matt surfaces"},
            with(&Around::world, &Around::world, &Around::dice, count("rays", "points on lamps per question", 1))),
        wrap<candela::GatheredGlow>(
            "CandelaGathered", {.help = "wrapped example: light that matt surroundings scatter once", .inputs = {1, 1}},
            with(&Around::world, &Around::input, &Around::dice, count("rays", "directions per question", 16))),
        wrap<candela::DimmedGlow>(
            "CandelaDimmed", {.help = "wrapped example: a part of its input, up to a limit", .inputs = {1, 1}},
            with(&Around::input, amount("strength", "the part", 1), amount("limit", "the most radiance", 1000))),
        wrap<candela::OpenGlow>("CandelaOpen",
                                {.help = "wrapped example: how open it is around a point", .alone = "chance"},
                                with(&Around::world, count("rays", "directions per question", 8),
                                     amount("near", "what keeps light off, scene units", 100))),
        wrap<candela::Eye>("CandelaEye",
                           {.help = "wrapped example: follows one ray at a time, through mirrors", .inputs = {1, 1}},
                           with(&Around::world, &Around::input, count("mirrors", "in a row that are followed", 8))),
    };
    for (Kind& kind : kinds) kind.reads = reading(scene_of_light | ScenePart::camera);
    return kinds;
}

}  // namespace lightnet
