// Final gathering by integrators that were not written for light: those of the GNU Scientific Library, plain Monte
// Carlo and MISER (Press & Farrar 1990). They ask for a function's value at one point after the other, through a
// pointer, and wait for it; they know nothing of lightnet, and are used as they are installed.
#include <gsl/gsl_errno.h>
#include <gsl/gsl_monte_miser.h>
#include <gsl/gsl_monte_plain.h>
#include <gsl/gsl_rng.h>

#include <memory>

#include "core/base/error.hpp"
#include "core/base/math/frame.hpp"
#include "core/base/math/sampling.hpp"
#include "core/network/light/plugin.hpp"
#include "core/network/light/wrap.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/surface_lookup.hpp"

namespace lightnet {
namespace {

/// How the library makes one of its integrators, uses it and frees it; `T` is what it calls the integrator's state.
template <class T>
struct Gsl;

template <>
struct Gsl<gsl_monte_plain_state> {
    static constexpr auto make = gsl_monte_plain_alloc;
    static constexpr auto integrate = gsl_monte_plain_integrate;
    static constexpr auto free = gsl_monte_plain_free;
};
template <>
struct Gsl<gsl_monte_miser_state> {
    static constexpr auto make = gsl_monte_miser_alloc;
    static constexpr auto integrate = gsl_monte_miser_integrate;
    static constexpr auto free = gsl_monte_miser_free;
};

/// What the surroundings of a question's point bring to it: a function over the unit square, whose integral the
/// question wants. The square is the hemisphere over the point, its cosine lying even.
class AroundPoint {
public:
    AroundPoint(const Scene& scene, OneByOne& inputs) : scene_(scene), inputs_(inputs), lookup_(scene) {}

    void look_at(const Query& question) {
        lookup_.forget();
        point_ = lookup_.point(question);
        outgoing_ = question.outgoing;
        normal_ = dot(point_->shading.z, outgoing_) < 0 ? -point_->shading.z : point_->shading.z;
        albedo_ = scene_.bsdf(*point_).evaluate(normal_, normal_, lobe::rough) * pi;
    }
    Rgb albedo() const { return albedo_; }
    /// `at` is of the square.
    Rgb arriving(Vec2 at) {
        const Vec3 direction = Frame::around(normal_).to_world(cosine_hemisphere(at));
        const auto hit = scene_.intersect({lookup_.origin(point_->position, direction), direction});
        if (!hit) return {};
        const SurfacePoint met = lookup_.point(*hit);
        return inputs_.ask(0, lookup_.question(met.position, met.shading.z, -direction));
    }

private:
    const Scene& scene_;
    OneByOne& inputs_;
    SurfaceLookup lookup_;
    std::optional<SurfacePoint> point_;
    Vec3 outgoing_, normal_;
    Rgb albedo_;
};

}  // namespace

/// All integrators of the library: they add up numbers, so each colour is an integral of its own, at the same points.
template <class T>
requires requires { Gsl<T>::make; }
struct Bridge<T> {
    Bridge(const NodeContext& here, OneByOne& inputs)
        : inputs_(inputs), around_(here.scene(), inputs), calls_(static_cast<std::size_t>(here.integer("calls"))) {}

    Rgb light(const Query& question) {
        around_.look_at(question);
        const Rgb albedo = around_.albedo();
        return {albedo.r * integral<&Rgb::r>(), albedo.g * integral<&Rgb::g>(), albedo.b * integral<&Rgb::b>()};
    }

private:
    template <float Rgb::*colour>
    float integral() {
        const auto value = [](double* at, std::size_t, void* around) -> double {
            const Rgb arriving =
                static_cast<AroundPoint*>(around)->arriving({static_cast<float>(at[0]), static_cast<float>(at[1])});
            return arriving.*colour;
        };
        gsl_monte_function function{value, 2, &around_};
        double from[] = {0, 0}, to[] = {1, 1}, result = 0, error = 0;
        gsl_rng_set(dice_.get(), inputs_.seed());
        if (const int wrong =
                Gsl<T>::integrate(&function, from, to, 2, calls_, dice_.get(), integrator_.get(), &result, &error))
            throw Error(gsl_strerror(wrong));
        return static_cast<float>(result);
    }

    OneByOne& inputs_;
    AroundPoint around_;
    std::size_t calls_;
    std::unique_ptr<gsl_rng, void (*)(gsl_rng*)> dice_{gsl_rng_alloc(gsl_rng_taus2), gsl_rng_free};
    std::unique_ptr<T, void (*)(T*)> integrator_{Gsl<T>::make(2), Gsl<T>::free};
};

namespace {

void add_integrators(std::vector<Kind>& kinds) {
    gsl_set_error_handler_off();  // which would end the process
    const std::vector<Param> params{count("calls", "directions per question and colour", 16).param};
    kinds.push_back(wrap<gsl_monte_plain_state>(
        "PlainGather", {.help = "gathers by plain Monte Carlo (GSL)", .inputs = {1, 1}, .params = params}));
    kinds.push_back(wrap<gsl_monte_miser_state>(
        "MiserGather", {.help = "gathers by MISER (GSL), which cuts the hemisphere up where calls are 1024 at least",
                        .inputs = {1, 1},
                        .params = params}));
}

}  // namespace
}  // namespace lightnet

extern "C" const lightnet::PluginCard* lightnet_plugin() {
    static const lightnet::PluginCard card{
        .name = "integrators", .version = "1.0", .add_kinds = lightnet::add_integrators};
    return &card;
}
