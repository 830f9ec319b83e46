// pbrt's shapes, made into meshes, spheres and quadrics.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/math/transform.hpp"
#include "core/base/thread_pool.hpp"
#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/sources.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

using Geometry = ShapeGeometry;

/// Where a shape stands.
struct Placement {
    Matrix to_world;
    Matrix from_world;
    bool reversed = false;  // ReverseOrientation

    /// Is the normal against the one that the shape has by itself? pbrt's rule: a mirroring turns it as well.
    bool flips() const { return reversed != swaps_handedness(to_world); }
};

/// What a scene takes of memory, counted in vertices and triangles.
class Budget {
public:
    static constexpr std::uint64_t most = std::uint64_t{1} << 27;  // about 4 GB, and as much again in Embree
    void take(const Geometry& geometry);
    void take(std::uint64_t size) { taken_ += size; }
    bool exceeded() const { return taken_ > most; }

private:
    std::atomic<std::uint64_t> taken_ = 0;
};

/// How a mesh is moved along its normals, once the textures are there.
struct Relief {
    TextureId heights = 0;
    float edge = 1;  // longer ones are split before, in the world
    Placement placement{};
};

/// A shape that was asked for. Meshes in files come later: wait for the thread_pool before looking.
struct MadeShape {
    std::optional<Geometry> geometry;
    std::optional<Relief> relief;  // of a mesh that is in its own space until then
    std::string problem;           // why there is none, as far as it isn't reported yet
};

/// Makes the shapes of one scene.
class Shapes {
public:
    Shapes(const Sources& sources, ThreadPool& thread_pool) : sources_(sources), thread_pool_(thread_pool) {}

    /// The shape of that type, where it stands. None: reported. `heights`: by which a 'plymesh' is displaced.
    std::shared_ptr<MadeShape> make(const std::string& type, Parameters& parameters, const Placement& placement,
                                    std::optional<TextureId> heights);
    /// Once textures and meshes are there: displaces what is to be.
    void displace(const std::vector<MadeShape*>& shapes, const std::vector<Texture>& textures);
    Budget& budget() { return budget_; }

private:
    std::shared_ptr<MadeShape> ply_mesh(Parameters& parameters, const Placement& placement,
                                        std::optional<TextureId> heights);

    const Sources& sources_;
    ThreadPool& thread_pool_;
    Budget budget_;
};

}  // namespace lightnet::pbrt
