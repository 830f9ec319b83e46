#include "core/scene/lamps/lights.hpp"

#include "core/base/math/prefix_cdf.hpp"
#include "core/base/thread_pool.hpp"
#include "core/scene/lamps/lamp_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

namespace lightnet {
Lights::Lights(const SceneData& data, const Shading& shading, const BallAround& around, const Wanted& wanted)
    : around_(around),
      groups_(wanted.apart ? std::max<std::size_t>(1, data.groups.size()) : 1),
      environment_group_(groups_ > 1 ? data.environment_group : 0),
      lamps_(data, shading, wanted.groups, groups_ > 1) {
    const auto is_wanted = [&](std::uint32_t group) { return (wanted.groups >> group & 1) != 0; };
    for (std::size_t i = 0; i < data.lights.size(); ++i)
        std::visit(
            [&](const auto& one) {
                if (is_wanted(one.label.group)) add(one, SceneMotion::steps_after(data.motion.lights, i));
            },
            data.lights[i]);
    if (is_wanted(data.environment_group)) skies_ = Skies(data, environment_group_);
    build_tree();

    std::vector<double> by_power(count());
    parallel_for(by_power.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) by_power[i] = luminance(power(i));
    });
    prefix_cdf(by_power, power_ends_);
}

template <IsLight L>
void Lights::add(const L& light, std::span<const BareLight> later) {
    if constexpr (IsFar<L>)
        far_.add(light.disk(), group(light.label));
    else if (later.empty())
        std::visit([&](auto&& ready) { near_.emplace_back(std::move(ready)); }, ReadyOf<L>(light.ready()));
    else
        near_.emplace_back(MovingLight<L>(light, later));
}

std::optional<LightSample> Lights::from_near(std::size_t light, const LitPoint& from) const {
    return std::visit(
        [&](const auto& one) {
            auto found = light_from(one, from.position, from.time);
            if (found) found->group = group(one.label);
            return found;
        },
        near_[light]);
}

void Lights::build_tree() {
    std::vector<LightBounds> bounds(lamps_.size());
    parallel_for(lamps_.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) bounds[i] = lamps_.bounds(i);
    });
    for (const NearLight& light : near_)
        bounds.push_back(std::visit([](const auto& one) { return one.bounds(); }, light));
    const auto in_tree =
        std::size_t(std::count_if(bounds.begin(), bounds.end(), [](const auto& b) { return b.intensity > 0; }));
    tree_ = LightTree(bounds);

    const std::size_t beside = far_.size() + (skies_.sampled() ? 1 : 0);
    choices_ = in_tree + beside;
    for (std::size_t i = 0; choices_ == 1 && i < lamps_.size(); ++i)
        if (bounds[i].intensity > 0) only_lamp_ = i;
    share_of_tree_ = in_tree ? 1 / float(1 + beside) : 0;
    share_of_far_ = beside ? (1 - share_of_tree_) / float(beside) : 0;
    if (!only_lamp_) return;
    const EvenLamp only = lamps_.even(*only_lamp_);
    if (const auto* flat = std::get_if<FlatLamp>(&only)) only_flat_lamp_ = *flat;
}

std::optional<LightSample> Lights::sample(const LitPoint& from, float choice, Vec2 u) const {
    if (only_lamp_) return lamps_.sample(*only_lamp_, from, u);
    return takes_tree(choice) ? from_tree(from, choice, u) : from_beside(from.position, choice, u);
}

std::optional<LightSample> Lights::from_tree(const LitPoint& from, float choice, Vec2 u) const {
    float place = place_in_tree(choice);
    const auto chosen = tree_.choose(from, place);
    return chosen ? from_chosen(*chosen, from, u) : std::nullopt;
}

std::optional<LightSample> Lights::from_chosen(const LightChoice& chosen, const LitPoint& from, Vec2 u) const {
    const std::size_t light = chosen.light;
    auto sample = light < lamps_.size() ? lamps_.sample(light, from, u) : from_near(light - lamps_.size(), from);
    if (sample) sample->pdf = sample->pdf * chosen.chance * share_of_tree_;
    return sample;
}

std::optional<LightSample> Lights::from_beside(Vec3 from, float choice, Vec2 u) const {
    if (!(share_of_far_ > 0)) return {};
    auto sample = from_infinity(from, (choice - share_of_tree_) / share_of_far_, u);
    if (sample) sample->pdf *= share_of_far_;
    return sample;
}

// `choice` counts the directional lights, and all maps as the last of them.
std::optional<LightSample> Lights::from_infinity(Vec3 from, float choice, Vec2 u) const {
    const auto light = std::size_t(std::max(0.0f, choice));
    if (light < far_.size()) return far_.sample(light, u);
    return skies_.sampled() ? skies_.sample(from, within(choice, float(far_.size()), 1), u) : std::nullopt;
}

float Lights::place_in_tree(float choice) const {
    return share_of_tree_ == 1 ? choice : within(choice, 0, share_of_tree_);
}

// As sample() goes.
bool Lights::takes_only_map(float choice) const {
    if (!skies_.one_map() || takes_tree(choice)) return false;
    return (choice - share_of_tree_) / share_of_far_ >= float(far_.size());
}

/// Points that go the same way. No `who`: they are all.
struct Lights::PointsAsked {
    std::span<const std::uint32_t> who;
    std::span<const LitPoint> from;
    std::span<const float> choices;
    std::span<const Vec2> u;
};
/// Points that are picked from many.
struct Lights::PointsPicked {
    std::size_t count = 0;
    std::array<std::uint32_t, lanes> who;
    std::array<LitPoint, lanes> from;
    std::array<float, lanes> choices;
    std::array<Vec2, lanes> u;

    void add(std::uint32_t i, const LitPoint& point, float choice, Vec2 place) {
        who[count] = i;
        from[count] = point;
        choices[count] = choice;
        u[count++] = place;
    }
    PointsAsked all() const {
        return {std::span(who).first(count), std::span(from).first(count), std::span(choices).first(count),
                std::span(u).first(count)};
    }
};

void Lights::sample(std::span<const LitPoint> from, std::span<const float> choices, std::span<const Vec2> u,
                    LightSamples& samples) const {
    if (only_lamp_) {
        std::array<LightChoice, lanes> chosen;
        chosen.fill({std::uint32_t(*only_lamp_), 1});
        return sample_chosen({{}, from, choices, u}, chosen, samples);
    }
    const bool tree_alone = share_of_tree_ == 1 && !choices.empty();
    if (tree_alone) return sample_tree({{}, from, choices, u}, samples);
    PointsPicked by_tree, by_map;
    for (std::uint32_t i = 0; i < u.size(); ++i) {
        const float choice = choices.empty() ? 0 : choices[i];
        if (takes_tree(choice))
            by_tree.add(i, from[i], place_in_tree(choice), u[i]);
        else if (takes_only_map(choice))
            by_map.add(i, from[i], choice, u[i]);
        else
            samples.set(i, from_beside(from[i].position, choice, u[i]));
    }
    if (by_tree.count > 0) sample_tree(by_tree.all(), samples);
    if (by_map.count > 0) sample_map(by_map.all(), samples);
}

void Lights::sample_tree(const PointsAsked& some, LightSamples& samples) const {
    const std::size_t count = some.u.size();
    std::array<LightChoice, lanes> chosen;
    std::array<float, lanes> places;
    std::copy_n(some.choices.begin(), count, places.begin());
    tree_.choose(some.from.first(count), places, chosen);
    if (tree_.large()) lamps_.expect(std::span(chosen).first(count));
    sample_chosen(some, chosen, samples);
}

void Lights::sample_chosen(const PointsAsked& some, std::span<const LightChoice> chosen, LightSamples& samples) const {
    LampPoints<FlatLampColumns> on_flat;
    LampPoints<BallLampColumns> on_balls;
    for (std::size_t k = 0; k < some.u.size(); ++k) {
        const LightChoice& one = chosen[k];
        const auto who = some.who.empty() ? static_cast<std::uint32_t>(k) : some.who[k];
        const LampAsked asked{who, some.from[k].position, some.u[k], one.chance};
        const bool shape = one.chance > 0 && one.light < lamps_.size();
        const EvenLamp* known = shape ? lamps_.known(one.light) : nullptr;
        if (const auto* flat = std::get_if<FlatLamp>(known))
            on_flat.add(asked, *flat);
        else if (const auto* ball = std::get_if<BallLamp>(known))
            on_balls.add(asked, *ball);
        else
            samples.set(asked.who, one.chance > 0 ? from_chosen(one, some.from[k], asked.u) : std::nullopt);
    }
    on_flat.find(share_of_tree_, samples);
    on_balls.find(share_of_tree_, samples);
}

void Lights::sample_map(const PointsAsked& some, LightSamples& samples) const {
    std::array<SkyRadiance, lanes> seen;
    skies_.sample(some.u, seen);
    for (std::size_t k = 0; k < some.u.size(); ++k) {
        LightSample found = skies_.sampled_as(seen[k]);
        found.pdf *= share_of_far_;
        samples.set(some.who[k], found);
    }
}

float Lights::pdf(const LitPoint& from, Vec3 direction, const SurfacePoint& on) const {
    const auto found = met(from, direction, on);
    float density = 0;
    if (found) pdfs({&*found, 1}, {&density, 1});
    return density;
}

std::optional<LampMet> Lights::met(const LitPoint& from, Vec3 direction, const SurfacePoint& on) const {
    const auto lamp = lamps_.lamp_at(on);
    if (!lamp) return {};
    return LampMet{from, std::uint32_t(*lamp), share_of_tree_ * lamps_.pdf(*lamp, from.position, direction, on)};
}

void Lights::pdfs(std::span<const LampMet> met, std::span<float> pdfs) const {
    std::ranges::fill(pdfs, 1.0f);
    if (many()) tree_.chances(met, pdfs);
    for (std::size_t i = 0; i < met.size(); ++i) pdfs[i] *= met[i].density;
}

void Lights::look_at_sky(std::span<const Ray> rays, std::span<SkyRadiance> seen) const {
    skies_.look(rays, seen);
    for (std::size_t i = 0; i < rays.size(); ++i) seen[i].pdf *= share_of_far_;
}

std::optional<SeenSun> Lights::sun(Vec3 direction) const {
    auto seen = far_.look(direction);
    if (seen) seen->light.pdf *= share_of_far_;
    return seen;
}

std::size_t Lights::memory() const {
    return lamps_.memory() + tree_.memory() + power_ends_.size() * sizeof(float) + skies_.memory();
}

}  // namespace lightnet
