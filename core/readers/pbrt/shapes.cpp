#include "core/readers/pbrt/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <numbers>
#include <utility>

#include "core/base/suggestion.hpp"
#include "core/base/words_of.hpp"
#include "core/readers/files/gzip.hpp"
#include "core/readers/pbrt/curves.hpp"
#include "core/readers/pbrt/meshes.hpp"
#include "core/readers/pbrt/older_shapes.hpp"
#include "core/readers/pbrt/quadrics.hpp"
#include "core/readers/pbrt/relief.hpp"
#include "core/readers/pbrt/transforms.hpp"
#include "core/readers/ply/mesh.hpp"
#include "core/scene/shapes/placed_quadric.hpp"

namespace lightnet::pbrt {
namespace {

constexpr float full_turn = 2 * std::numbers::pi_v<float>;

std::optional<Geometry> placed(std::optional<Mesh> mesh, Parameters& parameters, const Placement& placement,
                               bool turn) {
    if (!mesh) return std::nullopt;
    if (const std::string problem = place(*mesh, placement, turn); !problem.empty()) {
        parameters.error(problem);
        return std::nullopt;
    }
    return std::move(*mesh);
}

std::optional<Geometry> triangles(Parameters& parameters, const Placement& placement) {
    return placed(triangle_mesh(parameters), parameters, placement, placement.reversed);
}

std::optional<Geometry> bilinear(Parameters& parameters, const Placement& placement) {
    return placed(bilinear_mesh(parameters), parameters, placement, placement.reversed);
}

std::optional<Geometry> subdivision(Parameters& parameters, const Placement& placement) {
    return placed(subdivision_mesh(parameters), parameters, placement, placement.reversed);
}

/// The axes of a transform that scales all directions alike: its rotation (and mirroring) alone.
Matrix axes_of(const Matrix& matrix, double scale) {
    Matrix axes;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) axes.m[i][j] = matrix.m[i][j] / scale;
    return axes;
}

std::optional<Geometry> sphere(Parameters& parameters, const Placement& placement) {
    const float radius = parameters.number("radius", 1);
    if (!(radius > 0)) {
        parameters.error("the radius must be above 0");
        return std::nullopt;
    }
    SpherePart part{radius, parameters.number("zmin", -radius), parameters.number("zmax", radius),
                    parameters.number("phimax", 360) / 360 * full_turn};
    if (part.z_min > part.z_max) std::swap(part.z_min, part.z_max);
    part.phi_max = std::clamp(part.phi_max, 0.0f, full_turn);
    const auto scale = uniform_scale(placement.to_world);
    const bool whole = part.z_min <= -radius && part.z_max >= radius && part.phi_max >= full_turn;
    if (whole && scale) {
        const Vec3 center = transform_point(placement.to_world, {});
        const float size = float(radius * *scale);
        if (finite(center) && std::isfinite(size) && size > 0)
            return Sphere{center, size, placement.flips(), axes_of(placement.to_world, *scale)};
        parameters.error("centre or radius is not finite after the transforms");
        return std::nullopt;
    }
    return sphere_part(part, parameters, placement);
}

using ShapeMaker = std::optional<Geometry> (*)(Parameters&, const Placement&);

const std::map<std::string, ShapeMaker>& shape_makers() {
    static const std::map<std::string, ShapeMaker> table{{"trianglemesh", triangles},
                                                         {"sphere", sphere},
                                                         {"bilinearmesh", bilinear},
                                                         {"disk", disk},
                                                         {"cylinder", cylinder},
                                                         {"loopsubdiv", subdivision},
                                                         {"curve", curve}};
    return table;
}

/// Of pbrt-v3 alone.
template <auto make>
std::optional<Geometry> older(Parameters& parameters, const Placement& placement) {
    return placed(make(parameters), parameters, placement, placement.reversed);
}
const std::map<std::string, ShapeMaker>& older_shape_makers() {
    static const std::map<std::string, ShapeMaker> table{{"cone", older<cone>},
                                                         {"heightfield", older<height_field>},
                                                         {"hyperboloid", older<hyperboloid>},
                                                         {"paraboloid", older<paraboloid>}};
    return table;
}

Mesh read_mesh(const Bytes& bytes) { return is_gzip(*bytes) ? read_ply(gunzip(*bytes)) : read_ply(*bytes); }

Geometry placed_mesh(Mesh mesh, const Placement& placement) {
    if (const std::string problem = place(mesh, placement, placement.reversed); !problem.empty()) throw Error(problem);
    return mesh;
}

}  // namespace

void Budget::take(const Geometry& geometry) {
    constexpr std::uint64_t least = 16;
    const auto* mesh = std::get_if<Mesh>(&geometry);
    const auto* curves = std::get_if<Curves>(&geometry);
    take(least + (mesh ? mesh->triangles.size() + mesh->positions.size() : 0) + (curves ? curves->points.size() : 0));
}

std::shared_ptr<MadeShape> Shapes::make(const std::string& type, Parameters& parameters, const Placement& placement,
                                        std::optional<TextureId> heights) {
    if (budget_.exceeded()) {
        parameters.ignore_all();
        return nullptr;  // said in the end
    }
    if (type == "nurbs" && sources_.older()) {
        parameters.ignore_all();
        sources_.report.warn(parameters.where(),
                             fmt::format("shapes of type '{}' are not supported and left out", type));
        return nullptr;
    }
    if (type == "plymesh") return ply_mesh(parameters, placement, heights);
    const bool of_v3 = sources_.older() && older_shape_makers().contains(type);
    const auto& makers = of_v3 ? older_shape_makers() : shape_makers();
    const auto maker = makers.find(type);
    if (maker == makers.end()) {
        std::vector<std::string> known{"plymesh"};
        for (const auto& entry : shape_makers()) known.push_back(entry.first);
        parameters.error("unknown shape" + did_you_mean(type, known));
        parameters.ignore_all();
        return nullptr;
    }
    auto geometry = maker->second(parameters, placement);
    if (!geometry) return nullptr;
    budget_.take(*geometry);
    return std::make_shared<MadeShape>(MadeShape{std::move(geometry), {}, {}});
}

std::shared_ptr<MadeShape> Shapes::ply_mesh(Parameters& parameters, const Placement& placement,
                                            std::optional<TextureId> heights) {
    const std::string file = parameters.file("filename");
    const float edge = parameters.number("edgelength", 1);
    if (file.empty()) {
        parameters.error("parameter 'filename' is missing");
        return nullptr;
    }
    const auto bytes = sources_.read(file, parameters.where());
    if (!bytes) return nullptr;
    auto made = std::make_shared<MadeShape>();
    if (heights) made->relief = {*heights, edge, placement};
    thread_pool_.add([this, made, file, placement, bytes = *bytes] {
        if (budget_.exceeded()) return;
        try {
            made->geometry = made->relief ? read_mesh(bytes) : placed_mesh(read_mesh(bytes), placement);
            budget_.take(*made->geometry);
        } catch (const std::exception& problem) {
            made->problem = fmt::format("'{}': {}", file, words_of(problem));
        }
    });
    return made;
}

void Shapes::displace(const std::vector<MadeShape*>& shapes, const std::vector<Texture>& textures) {
    for (MadeShape* made : shapes)
        thread_pool_.add([this, made, &textures] {
            Mesh& mesh = std::get<Mesh>(*made->geometry);
            made->problem = raise(mesh, *made->relief, textures);
            budget_.take(*made->geometry);
            if (!made->problem.empty() || budget_.exceeded()) made->geometry.reset();
        });
    thread_pool_.finish();
}

}  // namespace lightnet::pbrt
