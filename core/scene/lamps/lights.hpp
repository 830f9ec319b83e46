// All lights of a scene, and how they are sampled.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/bare_lights/moving_light.hpp"
#include "core/scene/bare_lights/suns.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/lamps/area_lamps.hpp"
#include "core/scene/lamps/lamp_met.hpp"
#include "core/scene/lamps/light_tree.hpp"
#include "core/scene/lamps/lit_point.hpp"
#include "core/scene/lamps/skies.hpp"
#include "core/scene/shapes/ray.hpp"
#include "core/scene/surfaces/shading.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

/// Lamps, bare lights, suns and environments. Lamps and bare lights that are somewhere are chosen by a tree;
/// directional ones and the maps of the sky (all of them as one) stand beside that tree with equal chances. A constant
/// environment is never chosen: directions from the BSDF are the better ones for it everywhere, unless it is seen
/// through a portal, which is sampled as a map is, by its area. Any thread may ask.
class Lights {
public:
    /// Which lamps, and whether their groups are told apart; else all are of group 0.
    struct Wanted {
        GroupSet groups = all_groups;
        bool apart = false;
    };
    /// Looks at data and shading while it lives.
    Lights(const SceneData& data, const Shading& shading, const BallAround& around, const Wanted& wanted);

    /// How many are told apart.
    std::size_t groups() const { return groups_; }
    /// Of a lamp that a point of a surface belongs to.
    std::uint32_t group_of(const SurfacePoint& lamp) const {
        return groups_ > 1 && lamps_.lamp_at(lamp) ? lamps_.group_of(lamp.geometry) : 0;
    }
    std::uint32_t environment_group() const { return environment_group_; }

    /// There is nothing that sample() could find.
    bool empty() const { return choices_ == 0; }
    /// There is more than one light to choose from.
    bool many() const { return choices_ > 1; }
    /// None: no light can reach the point by this sample.
    std::optional<LightSample> sample(const LitPoint& from, float choice, Vec2 u) const;
    /// Samples a light for up to `lanes` points at once. No `choices`: there is but one light.
    void sample(std::span<const LitPoint> from, std::span<const float> choices, std::span<const Vec2> u,
                LightSamples& samples) const;
    /// What sample() always chooses, if that's a flat lamp; else null.
    const FlatLamp* only_flat_lamp() const { return only_flat_lamp_ ? &*only_flat_lamp_ : nullptr; }
    /// Density with which sample() finds the emitting point `on`, which lies in `direction` from `from`. 0: not a lamp.
    float pdf(const LitPoint& from, Vec3 direction, const SurfacePoint& on) const;
    /// pdf() in two steps: which lamp it is, and then how likely those are.
    std::optional<LampMet> met(const LitPoint& from, Vec3 direction, const SurfacePoint& on) const;
    void pdfs(std::span<const LampMet> met, std::span<float> pdfs) const;
    /// Density with which sample() finds the environment along a ray.
    float environment_pdf(const Ray& ray) const { return skies_.pdf(ray) * share_of_far_; }
    /// Does sample() choose the environment at all?
    bool samples_environment() const { return skies_.sampled(); }

    /// Radiance that a point of a surface emits into `direction`.
    Rgb emission(const SurfacePoint& point, Vec3 direction) const { return lamps_.radiance(point, direction); }
    bool shines(std::uint32_t shape) const { return lamps_.shines(shape); }
    /// Radiance of all environments along a ray that meets nothing.
    Rgb environment(const Ray& ray) const { return skies_.radiance(ray); }
    /// Both of up to `lanes` rays: radiance, and density with which sample() finds their directions.
    void look_at_sky(std::span<const Ray> rays, std::span<SkyRadiance> seen) const;
    bool has_environment() const { return skies_.shine(); }
    /// The sun in that direction, and density with which sample() finds it. None: there is none, or of one direction
    /// only, which no ray meets.
    std::optional<SeenSun> sun(Vec3 direction) const;
    bool has_suns() const { return far_.visible(); }
    /// Could the ray meet a lamp? False is certain.
    bool may_meet_lamp(const Ray& ray) const { return lamps_.may_meet(ray); }

    /// Light leaving one of all lights, chosen by power; what comes from infinity goes into the ball around the scene.
    /// None: nothing leaves by this sample.
    std::optional<Emission> emit(float choice, Vec2 position_sample, Vec2 direction_sample, ShutterTime time = 0) const;
    /// All that is emitted, W: by lamps, nearly where they are textured; from infinity, into that ball.
    Rgb power() const;

    /// Lamps (see AreaLamps), bare lights, suns and environments.
    std::size_t count() const { return lamps_.size() + near_.size() + far_.size() + skies_.size(); }
    std::size_t memory() const;

private:
    void build_tree();
    Rgb power(std::size_t light) const;
    std::optional<LightSample> from_tree(const LitPoint& from, float choice, Vec2 u) const;
    std::optional<LightSample> from_chosen(const LightChoice& chosen, const LitPoint& from, Vec2 u) const;
    std::optional<LightSample> from_near(std::size_t light, const LitPoint& from) const;
    template <IsLight L>
    void add(const L& light, std::span<const BareLight> later);
    std::optional<LightSample> from_beside(Vec3 from, float choice, Vec2 u) const;
    std::optional<LightSample> from_infinity(Vec3 from, float choice, Vec2 u) const;
    bool takes_tree(float choice) const { return share_of_tree_ == 1 || choice < share_of_tree_; }
    float place_in_tree(float choice) const;
    bool takes_only_map(float choice) const;
    struct PointsAsked;
    struct PointsPicked;
    void sample_tree(const PointsAsked& some, LightSamples& samples) const;
    void sample_chosen(const PointsAsked& some, std::span<const LightChoice> chosen, LightSamples& samples) const;
    void sample_map(const PointsAsked& some, LightSamples& samples) const;
    std::uint32_t group(const LampLabel& label) const { return groups_ > 1 ? label.group : 0; }

    BallAround around_;
    std::size_t groups_;
    std::uint32_t environment_group_;
    AreaLamps lamps_;
    std::vector<NearLight> near_;
    Suns far_;
    Skies skies_;
    LightTree tree_;                              // over lamps, then over what is near
    std::size_t choices_ = 0;                     // lights that sample() chooses from
    std::optional<std::size_t> only_lamp_;        // there is nothing else to choose from
    std::optional<FlatLamp> only_flat_lamp_;      // the same
    float share_of_tree_ = 0, share_of_far_ = 0;  // the latter: of each directional light, and of all maps together
    std::vector<float> power_ends_;               // share of the power: lamps, near, far, environments
};

}  // namespace lightnet
