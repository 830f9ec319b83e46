#include "core/estimate/shooting.hpp"

#include "core/base/error.hpp"

#include <algorithm>

namespace lightnet {
namespace {

constexpr std::size_t paths_per_shard = 16384;  // some 20 ms
constexpr std::size_t trials_per_shard = 4096;  // and their results travel, useful or not

void check_memory(std::size_t photons, const Shooting& shooting) {
    if (photons * sizeof(Photon) <= shooting.most_bytes) return;
    throw Error(std::to_string(photons) + " photons take " +
                std::to_string((photons * sizeof(Photon) + 999999) / 1000000) +
                " MB, more than its 'memory' allows: raise it, or send fewer 'photons'");
}

}  // namespace

Shooting Shooting::of(const NodeContext& here) {
    return {.paths = photon_paths(here.text("paths")),
            .emitted = static_cast<std::uint64_t>(here.integer("photons")),
            .aimed = here.flag("aim"),
            .key = child(mix(here.seed()), here.key()),
            .most_bytes = static_cast<std::size_t>(here.number("memory") * 1e6)};
}

std::vector<Param> shooting_params(double photons, const std::string& help_of_photons) {
    return {
        {.name = "photons",
         .type = ParamType::integer,
         .help = help_of_photons,
         .unit = "photons",
         .initial = Value{photons},
         .least = 1,
         .most = 4e9},
        {.name = "paths",
         .type = ParamType::text,
         .help = "which light: by way of mirrors and glass alone, by way of a rough surface, of either, or all of it",
         .initial = Value{"caustic"},
         .choices = {"caustic", "diffuse", "indirect", "all"}},
        {.name = "aim",
         .type = ParamType::flag,
         .help = "send most photons where, as trials show, they are of use",
         .initial = Value{true}},
        {.name = "memory",
         .type = ParamType::number,
         .help = "that the photons may take; more is an error",
         .unit = "MB",
         .initial = Value{1024.0},
         .least = 0,
         .most = 1e6},
    };
}

Param gather_radius(const std::string& help) {
    return {.name = "radius",
            .type = ParamType::number,
            .help = help + "; 0: a twentieth of the scene's radius",
            .unit = "scene units",
            .initial = Value{0.0},
            .least = 0};
}

float gather_radius(const NodeContext& here) {
    const auto radius = static_cast<float>(here.number("radius"));
    return radius == 0 ? 0.05f * here.scene().radius() : radius;
}

std::vector<std::string> paths_of_photons(const Node& node) {
    return {expression_of(photon_paths(std::get<std::string>(node.params.at("paths").data)))};
}

std::shared_ptr<const Aim> take_aim(Services& services, const Scene& scene, const Shooting& shooting) {
    auto aim = services.once<Aim>([] { return Aim(); });
    if (!shooting.aimed) return aim;
    // An eighth of the photons, and a fourth: more would take longer than they save.
    for (const std::uint64_t round : {0, 1}) {
        const PhotonShooter shooter(scene, shooting.paths, child(shooting.key, key_of("trials"), round));
        const std::uint64_t wanted = std::clamp<std::uint64_t>(shooting.emitted >> 3, 8192, 65536) << round;
        const auto trials = services.map<Trial>(
            (wanted + trials_per_shard - 1) / trials_per_shard, [&](std::size_t shard, std::vector<Trial>& out) {
                shooter.attempt(shard * trials_per_shard, trials_per_shard, *aim, out);
            });
        aim = services.once<Aim>([&] { return Aim(trials.all()); });
    }
    return aim;
}

std::size_t shards_each(const Shooting& shooting) {
    return std::size_t((shooting.emitted + paths_per_shard - 1) / paths_per_shard);
}

Mapped<Photon> shoot(Services& services, const Scene& scene, const Shooting& shooting, const Aim& aim,
                     std::size_t times) {
    const std::size_t each = shards_each(shooting);
    auto photons = services.map<Photon>(times * each, [&](std::size_t shard, std::vector<Photon>& out) {
        const std::uint64_t first = shard % each * paths_per_shard;
        const PhotonShooter shooter(scene, shooting.paths, child(shooting.key, key_of("ways"), shard / each));
        shooter.shoot(first, std::min<std::uint64_t>(paths_per_shard, shooting.emitted - first),
                      1 / double(shooting.emitted), aim, out);
    });
    check_memory(photons.size(), shooting);
    return photons;
}

std::vector<Mapped<Photon>> shoot_near(Services& services, const Scene& scene, const Shooting& shooting, const Aim& aim,
                                       float reach) {
    const PhotonShooter shooter(scene, shooting.paths, child(shooting.key, key_of("ways"), 0));
    const auto emit = [&](std::size_t shard, std::vector<Photon>& out) {
        const std::uint64_t first = shard * paths_per_shard;
        shooter.shoot(first, std::min<std::uint64_t>(paths_per_shard, shooting.emitted - first),
                      1 / double(shooting.emitted), aim, out);
    };
    auto photons = services.map_near<Photon>(shards_each(shooting), reach, emit,
                                             [](const Photon& photon) { return photon.position; });
    std::size_t count = 0;
    for (const auto& some : photons) count += some.size();
    check_memory(count, shooting);
    return photons;
}

std::vector<Vec3> landmarks_of(const Scene& scene, const Shooting& shooting) {
    constexpr std::size_t trials = 65536, emitted = 32768;
    std::vector<Trial> tried;
    if (shooting.aimed)
        PhotonShooter(scene, shooting.paths, child(shooting.key, key_of("landmark trials"), 0))
            .attempt(0, trials, Aim(), tried);
    std::vector<Photon> photons;
    PhotonShooter(scene, shooting.paths, child(shooting.key, key_of("landmarks"), 0))
        .shoot(0, emitted, 1, Aim(tried), photons);
    std::vector<Vec3> landmarks;
    for (const auto& photon : photons) landmarks.push_back(photon.position);
    return landmarks;
}

}  // namespace lightnet
