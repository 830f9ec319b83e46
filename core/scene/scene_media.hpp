// The media of a scene, and where each of them is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/media/bounds.hpp"
#include "core/scene/media/flight.hpp"
#include "core/scene/media/glow.hpp"
#include "core/scene/media/stretches.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

/// A part of a ray that lies in one medium.
struct MediumPiece {
    float begin, end;  // metres along the ray
    Rgb extinction;    // per metre, on average; an estimate where the medium is uneven
    bool scatters;     // could light be scattered on it?
};

/// Which medium fills a place is what the next shape along a ray says that parts media, whichever way it is met; where
/// there is none it is the medium around everything. So nobody has to remember in what he is. Shapes that only part
/// media are in nobody's way. Any thread may ask.
class Media {
public:
    /// Keeps looking at `data`. Throws Error where a shape names a medium that isn't there, or one can't be used.
    Media(const SceneData& data, const std::string& isa, std::uint32_t build_threads);
    ~Media();
    Media(const Media&) = delete;
    Media& operator=(const Media&) = delete;

    /// Is there any that a ray could be in?
    bool any() const { return any_; }
    /// What becomes of a path along a ray until ray.far, by null collisions where a medium is uneven (Woodcock et al.
    /// 1965; Novák et al. 2018). Of colours that collide differently one is chosen, by what the path has `carried` of
    /// each so far, and its density is the mean of all. `numbers`: see FlightNumbers.
    Flight fly(const Ray& ray, Rgb carried, Vec2 numbers) const;
    /// What is left of light along a ray until ray.far; an estimate where a medium is uneven: ratio tracking (Novák et
    /// al. 2014).
    Rgb transmittance(const Ray& ray, Vec2 numbers) const;
    /// Cuts a ray until ray.far, which is finite, into pieces no longer than `longest`, each in one medium, and appends
    /// those; but for what of a grid's medium lies outside of the grid.
    void cut(const Ray& ray, float longest, Vec2 numbers, std::vector<MediumPiece>& pieces) const;
    /// A point in a medium. Throws Error where there is no such medium: it may come from another host.
    SurfacePoint point(Vec3 position, std::uint16_t medium) const;
    /// How light is scattered by a collision there.
    Bsdf bsdf(const SurfacePoint& point) const;
    /// Light leaving a point of any of them, of the group 0; as Scene::emit() is of lamps. Of a medium around
    /// everything what lies within three times the radius of all shapes.
    std::optional<Emission> emit(float choice, Vec2 position_sample, Vec2 direction_sample, ShutterTime time) const;
    /// No less than they emit, W. 0: no light comes from them.
    double power() const { return glow_.power(); }
    /// Bytes of grids.
    std::size_t memory() const;

private:
    struct Borders;

    template <class Take>
    void each_stretch(const Ray& ray, Take&& take) const;
    void cut_uneven(const Ray& ray, const Stretch& way, float longest, FlightNumbers& numbers,
                    std::vector<MediumPiece>& pieces) const;

    const SceneData& data_;
    bool any_ = false;
    std::unique_ptr<const Borders> borders_;  // null: no shape parts media
    std::vector<CollisionBounds> bounds_;     // by medium; of even ones nothing
    Glow glow_;
};

}  // namespace lightnet
