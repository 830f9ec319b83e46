// Lights at a place of the scene, made ready, still or moving while the shutter is open.
#pragma once

#include <algorithm>
#include <concepts>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/base/each_once.hpp"
#include "core/base/math/shutter.hpp"
#include "core/scene/bare_lights/bare_light.hpp"
#include "core/scene/bare_lights/patterned_light.hpp"
#include "core/scene/bare_lights/slide_light.hpp"

namespace lightnet {

/// What ready() of a light gives, one of several.
template <class L>
using ReadyOf = EachOnce<decltype(std::declval<const L&>().ready())>;

/// A light at evenly spaced steps; between two of them it goes evenly, but for what takes long to make ready, such as
/// pictures that it throws, which stay turned as at the nearer step. Immutable; any thread may ask.
template <IsNear L>
class MovingLight {
public:
    template <class AnyLight>
    MovingLight(const L& first, std::span<const AnyLight> later) : label(first.label), said_{first} {
        for (const AnyLight& light : later) said_.push_back(std::get<L>(light));
        for (const L& light : said_) ready_.push_back(light.ready());
    }

    /// Each at its own time: see IsNearLight.
    std::optional<LightSample> from(Vec3 from, ShutterTime time) const {
        return at(time, [&](const auto& light, Vec3 away) {
            auto sample = light.from(from - away);
            if (sample) sample->position += away;
            return sample;
        });
    }
    Emission emission(Vec2 u, ShutterTime time) const {
        return at(time, [&](const auto& light, Vec3 away) {
            Emission emission = light.emission(u);
            emission.origin += away;
            return emission;
        });
    }
    /// Around all of its way.
    LightBounds bounds() const {
        const auto of_step = [](const auto& light) { return light.bounds(); };
        LightBounds all = std::visit(of_step, ready_.front());
        for (const auto& light : ready_) all = around_both(all, std::visit(of_step, light));
        return all;
    }
    /// All that it emits, W, where that is most.
    Rgb power() const {
        const auto of_step = [](const auto& light) { return Rgb(light.power()); };
        Rgb most;
        for (const auto& light : ready_)
            if (const Rgb step = std::visit(of_step, light); luminance(step) > luminance(most)) most = step;
        return most;
    }

    LampLabel label;

private:
    /// use(light as it is then, how far it stands from where it is then).
    template <class Use>
    auto at(ShutterTime time, const Use& use) const {
        const StepPlace place(said_.size(), time);
        const L now = said_[place.step].between(place, said_[place.step + 1]);
        const std::size_t nearer = place.step + (place.part < 0.5f ? 0 : 1);
        return std::visit(
            [&]<class Ready>(const Ready& light) {
                if constexpr (std::same_as<Ready, L>)
                    return use(now, Vec3{});
                else
                    return use(light, now.position - said_[nearer].position);
            },
            ready_[nearer]);
    }

    std::vector<L> said_;
    std::vector<ReadyOf<L>> ready_;
};

/// Of one light: what it is found by, still and moving.
template <class L>
struct FoundBy {
    using type = std::variant<>;
};
template <IsNear L>
struct FoundBy<L> {
    using type = EachOnce<ReadyOf<L>, MovingLight<L>>;
};
template <class Lights>
struct NearLightsOf;
template <class... Lights>
struct NearLightsOf<std::variant<Lights...>> {
    static_assert((IsLight<Lights> && ...), "a light must say what IsLight asks");
    using type = EachOnce<typename FoundBy<Lights>::type...>;
};
/// A light of the list that is at a place of the scene, made ready.
using NearLight = NearLightsOf<BareLight>::type;

/// At some time, whether or not it moves.
template <IsNearLight Still>
std::optional<LightSample> light_from(const Still& light, Vec3 at, ShutterTime) {
    return light.from(at);
}
template <class L>
std::optional<LightSample> light_from(const MovingLight<L>& light, Vec3 at, ShutterTime time) {
    return light.from(at, time);
}
template <IsNearLight Still>
Emission emission_of(const Still& light, Vec2 u, ShutterTime) {
    return light.emission(u);
}
template <class L>
Emission emission_of(const MovingLight<L>& light, Vec2 u, ShutterTime time) {
    return light.emission(u, time);
}

}  // namespace lightnet
