#include "core/run/assembly/fingerprint.hpp"

#include <bit>
#include <cmath>
#include <map>
#include <mutex>

#include "core/base/error.hpp"
#include "core/base/math/random.hpp"
#include "core/base/math/samples.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

class Digest {
public:
    void add(float value) { hash_ = mix(hash_ ^ std::bit_cast<std::uint32_t>(value)); }
    void add(std::uint32_t value) { hash_ = mix(hash_ ^ value); }
    std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_ = 0x6c6967687466ull;
};

constexpr std::uint32_t rays = 4096, calls = 4096, triangles = 256;

Vec3 direction_of(Samples& samples) {
    const auto [u, v] = samples.next_2d();
    const float z = 1 - 2 * u, r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 6.2831853f * v;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

SceneData test_scene() {
    Mesh mesh;
    for (std::uint32_t i = 0; i < triangles; ++i) {
        Samples samples(key_of("fingerprint triangle"), i);
        const Vec3 center = direction_of(samples) * (0.5f + samples.next());
        for (std::uint32_t corner = 0; corner < 3; ++corner)
            mesh.positions.push_back(center + direction_of(samples) * 0.3f);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    SceneData data;
    data.textures.push_back({});
    data.materials.push_back({});
    data.shapes.push_back({});
    data.shapes.back().geometry = std::move(mesh);
    data.shapes.push_back({});
    data.shapes.back().geometry = Sphere{{0.2f, 0.1f, -0.3f}, 0.4f, false, {}};
    data.shapes.push_back({});
    Quadric tin;
    tin.round = Quadric::Round::cylinder;
    tin.turn = 5;
    tin.to_world.m = {{{0.3, 0.1, -0.2, -0.1}, {0.3, 0.4, -0.2, 0.2}, {0.3, 0.4, 0.5, -0.1}, {0, 0, 0, 1}}};
    data.shapes.back().geometry = tin;
    data.shapes.push_back({});
    Curves hair;
    hair.points = {
        {-1, -0.5f, 0.2f, 0.05f}, {0.3f, 0.9f, -0.4f, 0.1f}, {0.5f, -0.8f, 0.3f, 0.2f}, {1, 0.6f, 0.1f, 0.1f}};
    hair.segments = {0};
    hair.strands = {0};
    data.shapes.back().geometry = std::move(hair);
    return data;
}

void trace(Digest& digest, const std::string& isa) {
    SceneOptions options;
    options.isa = isa;
    const Scene scene(test_scene(), options);
    for (std::uint32_t i = 0; i < rays; ++i) {
        Samples samples(key_of("fingerprint ray"), i);
        const Ray ray{direction_of(samples) * 2.5f, direction_of(samples)};
        const auto hit = scene.intersect(ray);
        digest.add(static_cast<std::uint32_t>(scene.occluded(ray)));
        if (!hit) continue;
        digest.add(hit->geometry);
        digest.add(hit->primitive);
        digest.add(hit->u);
        digest.add(hit->v);
        digest.add(hit->distance);
    }
}

void calculate(Digest& digest) {
    for (std::uint32_t i = 0; i < calls; ++i) {
        Samples samples(key_of("fingerprint call"), i);
        const auto [x, y] = samples.next_2d();
        for (const float value :
             {std::sin(10 * x), std::cos(10 * x), std::tan(x), std::exp(8 * x - 4), std::log(x + 1e-6f),
              std::pow(x, 3 * y), std::atan2(x - 0.5f, y - 0.5f), std::acos(2 * x - 1), std::sqrt(x)})
            digest.add(value);
    }
}

std::uint64_t computed(const std::string& isa) {
    Digest digest;
    trace(digest, isa);
    calculate(digest);
    return digest.value();
}

/// What was computed stays true as long as the process lives. Names that are no instruction set are not kept.
class Known {
public:
    std::uint64_t of(const std::string& isa) {
        const std::lock_guard lock(known_mutex_);
        if (const auto found = known_.find(isa); found != known_.end()) return found->second;
        return known_[isa] = computed(isa);
    }

private:
    std::mutex known_mutex_;
    std::map<std::string, std::uint64_t> known_;
};

}  // namespace

std::uint64_t fingerprint(const std::string& isa) {
    static Known known;
    return known.of(isa);
}

std::string usual_isa() {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx2") ? "avx2" : "sse4.2";
}

}  // namespace lightnet
