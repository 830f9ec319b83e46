// A scene that can be asked: geometry in Embree, materials, lights, camera. Immutable after construction.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/lamp_groups.hpp"
#include "core/base/math/box.hpp"
#include "core/base/query.hpp"
#include "core/base/scene_parts.hpp"
#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/camera/camera.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/lamps/lamp_met.hpp"
#include "core/scene/lamps/lit_point.hpp"
#include "core/scene/shapes/ray.hpp"
#include "core/scene/surfaces/column_shape.hpp"
#include "core/scene/surfaces/flat_lamp.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

class Lights;
class Media;

/// How the scene is built. The same values on every host of a run, as the bytes of its answers may depend on them.
struct SceneOptions {
    std::string isa = "avx2";             // Embree's instruction set
    std::uint32_t width = 0, height = 0;  // of the picture; 0: as the scene says
    std::uint32_t build_threads = 0;      // that build trees; 0: one per core. No byte depends on it
};

/// How large a scene is. Bytes are those that it holds while it lives.
struct SceneSize {
    std::size_t triangles = 0;            // as stored; those of an object count once
    std::size_t instanced_triangles = 0;  // as seen: once for each instance
    std::size_t lights = 0;               // lamps (a flat one or a ball counts once, else each triangle), bare
                                          // lights and environments
    std::size_t shape_bytes = 0;          // vertices and triangles, which the trees share
    std::size_t tree_bytes = 0;           // BVHs
    std::size_t texture_bytes = 0;        // images, each once; those of environments, too
    std::size_t light_bytes = 0;
};

/// What of a scene somebody sees: which lamps are looked for, whether their groups are told apart, and which parts may
/// be read at all.
struct SceneView {
    GroupSet groups = all_groups;
    bool apart = false;
    SceneParts parts = whole_scene;
    friend auto operator<=>(const SceneView&, const SceneView&) = default;
};

/// Built once per process and shared by all its places: every member may be called from any thread. What reads a part
/// that its view leaves out throws Error.
// DECISIONS: undeclared-reads-end-a-run
class Scene {
public:
    explicit Scene(SceneData data, const SceneOptions& options = {});
    /// A scene as if there were no other lamps than these, and nothing to be read but those parts. It shares all but
    /// what finds other lamps than `whole` does, and what was a lamp is in the way of light as before.
    Scene(const Scene& whole, const SceneView& view);
    /// A scene as another looks at it. It shares all but the camera.
    Scene(const Scene& whole, const Onlooker& by, const SceneOptions& options);
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// The nearest hit in (0, ray.far). The hit is the same for single rays and packets, whatever the others are.
    std::optional<Hit> intersect(const Ray& ray) const;
    /// The nearest hits of many rays; `hits[i]` is empty where ray i leaves the scene.
    void intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;
    /// Is anything in (0, ray.far)?
    bool occluded(const Ray& ray) const;
    /// What is hidden from many rays: `hidden[i]` is 1 where something is in the way of ray i, else 0.
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> hidden) const;

    /// The surface point that is nearest to `position`, within `reach` (scene units); where several are, `normal` says
    /// how the one lies that is meant: a surface at right angles to it counts as farther away, by `reach`. Unit, on
    /// either side; zero: that is not known. The same on every host.
    std::optional<Hit> nearest(Vec3 position, Vec3 normal, float reach) const;

    SurfacePoint surface(const Hit& hit) const;
    /// Appends the surface point of a hit, made where it is to stay.
    void add_surface(const Hit& hit, std::vector<SurfacePoint>& to) const;
    /// Fetches what will be asked about them from memory: of some at once, before the first is.
    void expect(std::span<const std::optional<Hit>> hits) const;
    /// Of what a question names; a point in a medium as well.
    SurfacePoint surface(const Query& query) const {
        return query.is_in_space() ? point_in_space(query.place_in_space(), query.medium, query.time)
                                   : surface(hit(query));
    }
    /// Texture coordinates of a surface point, also where its material asks for none, and it has none of its own.
    Vec2 texture_coordinates(const SurfacePoint& point) const;
    /// What a question names, as if a ray had met it. Throws Error if it isn't there: it may come from another host.
    Hit hit(const Query& query) const;
    /// A point in a medium. Throws Error if there is no such medium.
    SurfacePoint point_in_space(Vec3 position, std::uint16_t medium, ShutterTime time = 0) const;

    /// Does anything but the camera move while the shutter is open? Where nothing does, all times are alike.
    bool moves() const;
    /// Does the surface move that was hit?
    bool moves(const Hit& hit) const;

    /// Is there any medium? Where there is none, nobody needs to ask what follows.
    bool has_media() const { return view_.parts.expect(ScenePart::media), has_media_; }
    const Media& media() const;

    /// What the scene was built from: names of shapes, materials and objects. Its meshes may be gone, and who looks is
    /// who looked then. All parts must be in view.
    const SceneData& data() const;
    /// One of its lists: of shapes, materials, objects or instances.
    template <class T>
    const std::vector<T>& all() const;
    /// By shape: how its points are shaded many at once. What is hit in an instance is not.
    std::span<const ColumnShape> column_shapes() const;
    /// Bsdf::lobes() all over the surface that was hit; 0: they are not the same everywhere, or it has none.
    std::uint8_t lobes(const Hit& hit) const;
    /// How the surface scatters there.
    Bsdf bsdf(const SurfacePoint& point) const;
    /// Appends how surfaces scatter at many points, made where they are to stay.
    void add_bsdfs(std::span<const SurfacePoint> points, std::vector<Bsdf>& to) const;

    /// All that shines, as far as it is in view.
    const Lights& lights() const { return view_.parts.expect(ScenePart::lamps), *lights_; }
    /// Could the ray end where light comes from? False is certain, true is a guess that is cheaper than tracing it.
    bool may_shine(const Ray& ray) const;
    /// The ray on which nothing may be if the surface point is to see a light.
    Ray ray_to(const SurfacePoint& from, const LightSample& lamp) const;

    const Camera& camera() const { return view_.parts.expect(ScenePart::camera), camera_; }
    /// What it was made of.
    const CameraData& seen_from() const { return view_.parts.expect(ScenePart::camera), onlooker_.camera; }
    const FilmData& film() const { return view_.parts.expect(ScenePart::film), onlooker_.film; }
    /// The box around everything that rays can meet.
    Box bounds() const;
    /// Radius of the sphere around everything, metres.
    float radius() const;
    SceneSize size() const;

    /// Rays traced so far by the calling thread, for the run's counters.
    static std::uint64_t rays_of_this_thread();

private:
    struct Built;
    std::shared_ptr<const Built> built_;
    std::shared_ptr<const Lights> lights_;
    SceneView view_;
    Onlooker onlooker_;
    Camera camera_;
    bool has_media_ = false;
};

}  // namespace lightnet
