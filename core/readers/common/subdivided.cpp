#include "core/readers/common/subdivided.hpp"

#include <fmt/format.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/unwanted.hpp"

namespace lightnet {
namespace {

using OpenSubdiv::Far::TopologyRefiner;
using Level = OpenSubdiv::Far::TopologyLevel;
using SdcOptions = OpenSubdiv::Sdc::Options;
using Descriptor = OpenSubdiv::Far::TopologyDescriptor;

/// A value at a vertex, as OpenSubdiv sums it.
template <class T>
struct Sum {
    T value{};
    void Clear() { value = {}; }
    void AddWithWeight(const Sum& other, float weight) { value = value + other.value * weight; }
};
template <class T>
using Sums = std::vector<Sum<T>>;

template <class T>
Sums<T> sums_of(const std::vector<T>& values) {
    Sums<T> sums;
    sums.reserve(values.size());
    for (const T& value : values) sums.push_back({value});
    return sums;
}

SdcOptions options_of(const Cage& cage) {
    SdcOptions options;
    constexpr std::array borders{SdcOptions::VTX_BOUNDARY_NONE, SdcOptions::VTX_BOUNDARY_EDGE_AND_CORNER,
                                 SdcOptions::VTX_BOUNDARY_EDGE_ONLY};
    constexpr std::array straight{SdcOptions::FVAR_LINEAR_NONE,          SdcOptions::FVAR_LINEAR_CORNERS_ONLY,
                                  SdcOptions::FVAR_LINEAR_CORNERS_PLUS1, SdcOptions::FVAR_LINEAR_CORNERS_PLUS2,
                                  SdcOptions::FVAR_LINEAR_BOUNDARIES,    SdcOptions::FVAR_LINEAR_ALL};
    options.SetVtxBoundaryInterpolation(borders.at(std::size_t(cage.borders)));
    options.SetFVarLinearInterpolation(straight.at(std::size_t(cage.straight_uvs)));
    options.SetCreasingMethod(cage.chaikin ? SdcOptions::CREASE_CHAIKIN : SdcOptions::CREASE_UNIFORM);
    return options;
}

/// The cage as OpenSubdiv takes it.
class Topology {
public:
    explicit Topology(const Cage& cage)
        : sizes_(cage.sizes.begin(), cage.sizes.end()),
          corners_(cage.corners.begin(), cage.corners.end()),
          uv_corners_(cage.uv_corners.begin(), cage.uv_corners.end()),
          holes_(cage.holes.begin(), cage.holes.end()) {
        for (const auto& crease : cage.creases) {
            crease_vertices_.insert(crease_vertices_.end(), {int(crease.a), int(crease.b)});
            crease_weights_.push_back(crease.sharpness);
        }
        for (const auto& tip : cage.tips) tips_.push_back(int(tip.vertex)), tip_weights_.push_back(tip.sharpness);
        all_.numVertices = int(cage.positions.size());
        all_.numFaces = int(sizes_.size());
        all_.numVertsPerFace = sizes_.data();
        all_.vertIndicesPerFace = corners_.data();
        all_.numCreases = int(crease_weights_.size());
        all_.creaseVertexIndexPairs = crease_vertices_.data();
        all_.creaseWeights = crease_weights_.data();
        all_.numCorners = int(tips_.size());
        all_.cornerVertexIndices = tips_.data();
        all_.cornerWeights = tip_weights_.data();
        all_.numHoles = int(holes_.size());
        all_.holeIndices = holes_.data();
        uvs_.numValues = int(cage.uvs.size());
        uvs_.valueIndices = uv_corners_.data();
        all_.numFVarChannels = uv_corners_.empty() ? 0 : 1;
        all_.fvarChannels = &uvs_;
    }
    Topology(const Topology&) = delete;

    /// Null: these make no surface.
    std::unique_ptr<TopologyRefiner> refiner(const SdcOptions& options) const {
        using Factory = OpenSubdiv::Far::TopologyRefinerFactory<Descriptor>;
        Factory::Options how(OpenSubdiv::Sdc::SCHEME_CATMARK, options);
        how.validateFullTopology = true;
        return std::unique_ptr<TopologyRefiner>(Factory::Create(all_, how));
    }

private:
    std::vector<int> sizes_, corners_, uv_corners_, holes_, crease_vertices_, tips_;
    std::vector<float> crease_weights_, tip_weights_;
    Descriptor::FVarChannel uvs_;
    Descriptor all_;
};

/// Values of the finest level.
struct Limit {
    std::vector<Vec3> positions, normals;
    std::vector<Rgb> colours;
    std::vector<Vec2> uvs;
};

template <class T>
std::vector<T> values_of(const Sums<T>& sums) {
    std::vector<T> values;
    values.reserve(sums.size());
    for (const auto& sum : sums) values.push_back(sum.value);
    return values;
}

Limit limit_of(const TopologyRefiner& refiner, const Cage& cage) {
    const OpenSubdiv::Far::PrimvarRefiner primvars(refiner);
    auto places = sums_of(cage.positions);
    auto colours = sums_of(cage.colours);
    auto uvs = sums_of(cage.uv_corners.empty() ? std::vector<Vec2>() : cage.uvs);
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        end_if_unwanted();
        const auto size = std::size_t(refiner.GetLevel(level).GetNumVertices());
        Sums<Vec3> finer(size);
        primvars.Interpolate(level, places, finer);
        places = std::move(finer);
        if (!colours.empty()) {
            Sums<Rgb> mixed(size);
            primvars.InterpolateVarying(level, colours, mixed);
            colours = std::move(mixed);
        }
        if (!uvs.empty()) {
            Sums<Vec2> laid(std::size_t(refiner.GetLevel(level).GetNumFVarValues(0)));
            primvars.InterpolateFaceVarying(level, uvs, laid);
            uvs = std::move(laid);
        }
    }
    Sums<Vec3> ends(places.size()), along(places.size()), across(places.size());
    primvars.Limit(places, ends, along, across);
    Limit limit{values_of(ends), {}, values_of(colours), {}};
    for (std::size_t i = 0; i < ends.size(); ++i) limit.normals.push_back(cross(along[i].value, across[i].value));
    if (!uvs.empty()) {
        Sums<Vec2> laid(uvs.size());
        primvars.LimitFaceVarying(uvs, laid);
        limit.uvs = values_of(laid);
    }
    return limit;
}

/// Triangles of the finest level's faces, whose vertices are cut where texture coordinates or normals are.
class Surface {
public:
    Surface(const TopologyRefiner& refiner, const Limit& limit)
        : refiner_(refiner),
          level_(refiner.GetLevel(refiner.GetMaxLevel())),
          limit_(limit),
          first_(limit.positions.size(), none) {}

    Subdivided of_faces() {
        for (int face = 0; face < level_.GetNumFaces(); ++face) {
            if (face % 4096 == 0) end_if_unwanted();
            if (!level_.IsFaceHole(face)) add(face);
        }
        return std::move(surface_);
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    struct Cut {
        int uv;
        std::uint32_t next;  // of the same place, or none
    };

    void add(int face) {
        const auto corners = level_.GetFaceVertices(face);
        std::array<std::uint32_t, 4> quad{};
        for (int i = 0; i < 4; ++i)
            quad[std::size_t(i)] = vertex(corners[i], limit_.uvs.empty() ? 0 : level_.GetFaceFVarValues(face)[i],
                                          normal(face, corners[i]));
        int origin = face;
        for (int level = refiner_.GetMaxLevel(); level > 0; --level)
            origin = refiner_.GetLevel(level).GetFaceParentFace(origin);
        surface_.mesh.triangles.insert(surface_.mesh.triangles.end(),
                                       {{quad[0], quad[1], quad[2]}, {quad[0], quad[2], quad[3]}});
        surface_.face_of.insert(surface_.face_of.end(), 2, std::uint32_t(origin));
    }

    std::uint32_t vertex(int place, int uv, Vec3 normal) {
        std::uint32_t& first = first_[std::size_t(place)];
        for (auto known = first; known != none; known = cuts_[known].next)
            if (cuts_[known].uv == uv && surface_.mesh.normals[known] == normal) return known;
        Mesh& mesh = surface_.mesh;
        const auto index = std::uint32_t(mesh.positions.size());
        mesh.positions.push_back(limit_.positions[std::size_t(place)]);
        mesh.normals.push_back(normal);
        if (!limit_.colours.empty()) mesh.colours.push_back(limit_.colours[std::size_t(place)]);
        if (!limit_.uvs.empty()) mesh.uvs.push_back(limit_.uvs[std::size_t(uv)]);
        cuts_.push_back({uv, std::exchange(first, index)});
        return index;
    }

    /// Of a face, at one of its corners.
    Vec3 facing(int face, int vertex) const {
        const auto corners = level_.GetFaceVertices(face);
        const int at = corners.FindIndex(vertex);
        const auto place = [&](int i) { return limit_.positions[std::size_t(corners[(at + i) % 4])]; };
        return cross(place(1) - place(0), place(3) - place(0));
    }

    bool parts(int edge) const {
        return level_.IsEdgeNonManifold(edge) || OpenSubdiv::Sdc::Crease::IsInfinite(level_.GetEdgeSharpness(edge));
    }

    /// Of the surface there, on that side of its creases.
    Vec3 normal(int face, int vertex) const {
        const auto edges = level_.GetVertexEdges(vertex);
        const bool creased = std::any_of(edges.begin(), edges.end(),
                                         [&](int edge) { return parts(edge) && level_.GetEdgeFaces(edge).size() > 1; });
        const Vec3 smooth = limit_.normals[std::size_t(vertex)];
        if (!creased && dot(smooth, smooth) > 0) return smooth;
        std::vector<int> side{face};
        Vec3 sum = facing(face, vertex);
        for (std::size_t i = 0; i < side.size(); ++i)
            for (const int edge : level_.GetFaceEdges(side[i]))
                if (edges.FindIndex(edge) != OpenSubdiv::Far::INDEX_INVALID && !parts(edge))
                    for (const int beyond : level_.GetEdgeFaces(edge))
                        if (std::ranges::find(side, beyond) == side.end()) side.push_back(beyond);
        std::ranges::sort(side);  // all faces of a side get the same bits
        sum = {};
        for (const int one : side) sum = sum + facing(one, vertex);
        return sum;
    }

    const TopologyRefiner& refiner_;
    const Level& level_;
    const Limit& limit_;
    Subdivided surface_;
    std::vector<std::uint32_t> first_;  // vertex of each place, or none
    std::vector<Cut> cuts_;             // as many as vertices
};

}  // namespace

// DECISIONS: cages-by-opensubdiv
Subdivided subdivided(const Cage& cage, int levels) {
    std::size_t triangles = 2 * cage.corners.size();
    for (int level = 1; level < levels && triangles <= most_triangles_by_subdivision; ++level) triangles *= 4;
    if (triangles > most_triangles_by_subdivision)
        throw Error(
            fmt::format("{} subdivisions make more than {} triangles of it", levels, most_triangles_by_subdivision));
    const auto refiner = Topology(cage).refiner(options_of(cage));
    if (!refiner) throw Error("its faces don't make a surface");
    TopologyRefiner::UniformOptions how{levels};
    how.fullTopologyInLastLevel = true;
    refiner->RefineUniform(how);
    const Limit limit = limit_of(*refiner, cage);
    return Surface(*refiner, limit).of_faces();
}

}  // namespace lightnet
