#include "core/estimate/shooting.hpp"

#include "core/base/error.hpp"

#include <algorithm>
#include <variant>

namespace lightnet {
namespace {

constexpr std::size_t paths_per_shard = 16384;  // some 20 ms
constexpr std::size_t trials_per_shard = 4096;  // and their results travel, useful or not
constexpr std::size_t beams_per_shard = 2048;   // light paths that leave beams
constexpr double smallest_part = 0.01;          // of the scene, by its light, of which an error is told

// Light paths for what is learnt beforehand; `unknown`: as long as nobody has decided how many there will be.
std::uint64_t an_eighth(const Shooting& shooting, std::uint64_t unknown, std::uint64_t most) {
    constexpr std::uint64_t least = 8192;
    return shooting.emitted ? std::clamp(shooting.emitted >> 3, least, most) : unknown;
}

std::uint64_t enough_paths(const Shooting& shooting, std::uint64_t pilot_paths, std::size_t pilot_kept, double missed) {
    const double noise = 1 / (smallest_part * shooting.error * shooting.error);
    const double off_surfaces = double(pilot_paths) * missed * missed / shooting.error;
    const double per_path = double(pilot_kept) / double(pilot_paths), fit = 0.9 * double(shooting.planned_bytes);
    const double most = std::min(4e9, fit / sizeof(Photon) / std::max(per_path, 1e-3));
    return std::uint64_t(std::clamp(std::max(noise, off_surfaces), 1.0, std::max(1.0, most)));
}

void check_memory(std::size_t count, std::size_t size, const std::string& what, const Shooting& shooting) {
    if (count * size <= shooting.most_bytes) return;
    throw Error(std::to_string(count) + " " + what + " take " + std::to_string((count * size + 999999) / 1000000) +
                " MB, more than its 'memory' allows: raise it, or send fewer '" + what + "'");
}
void check_memory(std::size_t photons, const Shooting& shooting) {
    check_memory(photons, sizeof(Photon), "photons", shooting);
}

// What every machine is taken to have for them.
std::size_t planned_memory(const NodeContext& here) {
    const double given = here.number("memory") * 1e6;
    return static_cast<std::size_t>(given > 0 ? given : 1e9);
}

// A budget: where it ends the run says so, and where it does not it changes nothing. So no number of photons may follow
// from it, as machines differ.
std::size_t memory_for_photons(const NodeContext& here) {
    const std::size_t planned = planned_memory(here);
    return here.number("memory") > 0 ? planned : std::max<std::size_t>(planned, memory_for(here) / 4);
}

}  // namespace

Shooting Shooting::of(const NodeContext& here) {
    return {.paths = photon_paths(here.text("paths")),
            .emitted = static_cast<std::uint64_t>(here.integer("photons")),
            .aimed = here.flag("aim"),
            .key = child(mix(here.seed()), here.key()),
            .most_bytes = memory_for_photons(here),
            .planned_bytes = planned_memory(here)};
}

Shooting Shooting::with_error(const NodeContext& here) {
    Shooting shooting = of(here);
    shooting.error = here.number("error");
    return shooting;
}

std::vector<Param> shooting_params(double photons, const std::string& help_of_photons) {
    std::vector<Param> params{
        {.name = "photons",
         .type = ParamType::integer,
         .help = help_of_photons,
         .unit = "photons",
         .initial = Value{photons},
         .least = photons > 0 ? 1.0 : 0.0,
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
         .help = "that the photons may take; more is an error; 0: a quarter of the machine's",
         .unit = "MB",
         .initial = Value{0.0},
         .least = 0,
         .most = 1e6},
    };
    if (photons == 0)
        params.insert(params.begin() + 1,
                      {.name = "error",
                       .type = ParamType::number,
                       .help = "where it decides how many: how far the light of a part of the scene that gets a "
                               "hundredth of it may be off",
                       .initial = Value{0.01},
                       .least = 0.001,
                       .most = 1});
    return params;
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

bool may_keep_any(const Scene& scene, PhotonPaths paths) {
    const auto& materials = scene.all<Material>();
    return paths != PhotonPaths::caustic || !std::all_of(materials.begin(), materials.end(), [](const Material& one) {
               return std::holds_alternative<DiffuseMaterial>(one.model);
           });
}

std::shared_ptr<const Aim> take_aim(Services& services, const Scene& scene, const Shooting& shooting,
                                    PhotonShooter::Kept what) {
    auto aim = services.once<Aim>([] { return Aim(); });
    if (!shooting.aimed) return aim;
    // An eighth of the photons, and a fourth: more would take longer than they save.
    constexpr std::uint64_t most = 65536;
    for (const std::uint64_t round : {0, 1}) {
        const PhotonShooter shooter(scene, shooting.paths, child(shooting.key, key_of("trials"), round));
        const std::uint64_t wanted = an_eighth(shooting, most, most) << round;
        const auto trials = services.map<Trial>(
            (wanted + trials_per_shard - 1) / trials_per_shard, [&](std::size_t shard, std::vector<Trial>& out) {
                shooter.attempt(shard * trials_per_shard, trials_per_shard, *aim, out, what);
            });
        aim = services.once<Aim>([&] { return Aim(trials.all()); });
    }
    return aim;
}

std::size_t shards_each(const Shooting& shooting) {
    return std::size_t((shooting.emitted + paths_per_shard - 1) / paths_per_shard);
}

namespace {

// A shard of the map with this number.
void shoot_shard(const Scene& scene, const Shooting& shooting, const Aim& aim, const PhotonSpread& spread,
                 std::uint64_t map, std::size_t shard, std::vector<Photon>& out) {
    const std::uint64_t first = shard * paths_per_shard;
    const PhotonShooter shooter(scene, shooting.paths, child(shooting.key, key_of("ways"), map));
    shooter.shoot(first, std::min<std::uint64_t>(paths_per_shard, shooting.emitted - first),
                  1 / double(shooting.emitted), aim, out);
    spread.spread(out, child(shooting.key, key_of("spread"), map * shards_each(shooting) + shard));
}

}  // namespace

Mapped<Photon> shoot(Services& services, const Scene& scene, const Shooting& shooting, const Aim& aim,
                     const PhotonMaps& maps) {
    const std::size_t each = shards_each(shooting);
    auto photons = services.map<Photon>(maps.radii.size() * each, [&](std::size_t shard, std::vector<Photon>& out) {
        const std::size_t map = shard / each;
        shoot_shard(scene, shooting, aim, {scene, maps.radii[map]}, maps.first + map, shard % each, out);
    });
    check_memory(photons.size(), shooting);
    return photons;
}

namespace {

/// Fewer photons of the same kind, from which the size of the map's discs is told.
struct Pilot {
    std::uint64_t paths;
    Mapped<Photon> photons;
    std::shared_ptr<const PhotonTree> tree;
};

Pilot take_pilot(Services& services, const Scene& scene, const Shooting& shooting, const Aim& aim,
                 std::uint64_t paths) {
    const PhotonShooter shooter(scene, shooting.paths, child(shooting.key, key_of("pilot")));
    auto photons = services.map<Photon>(
        std::size_t((paths + trials_per_shard - 1) / trials_per_shard),
        [&](std::size_t shard, std::vector<Photon>& out) {
            const std::uint64_t first = shard * trials_per_shard;
            shooter.shoot(first, std::min<std::uint64_t>(trials_per_shard, paths - first), 1 / double(paths), aim, out);
        });
    auto tree = services.once<PhotonTree>([&](Builders& builders) { return PhotonTree(photons.all(), builders); });
    return {paths, std::move(photons), std::move(tree)};
}

}  // namespace

// DECISIONS: pilots-grow
PhotonSpread take_spread(Services& services, const Scene& scene, Shooting& shooting, const Aim& aim, std::size_t gather,
                         float radius) {
    const auto wanted = [&] { return an_eighth(shooting, 1 << 17, 1 << 22); };
    Pilot pilot = take_pilot(services, scene, shooting, aim, wanted());
    if (shooting.emitted == 0) {
        const PhotonSpread as_it_is(scene, pilot.tree, gather, 1, radius);
        const auto parts = services.map<PhotonSpread::Missed>(pilot.photons.shards(), [&](std::size_t shard,
                                                                                          auto& out) {
            out.push_back(as_it_is.missed(pilot.photons.shard(shard), child(shooting.key, key_of("missed"), shard)));
        });
        PhotonSpread::Missed sum;
        for (const auto& part : parts) sum.missed += part.missed, sum.all += part.all;
        shooting.emitted =
            enough_paths(shooting, pilot.paths, pilot.photons.size(), sum.all > 0 ? sum.missed / sum.all : 0);
        services.say(std::to_string(shooting.emitted) + " light paths, as the error wants");
    }
    if (wanted() > 2 * pilot.paths)  // else the first one does
        pilot = take_pilot(services, scene, shooting, aim, wanted());
    return {scene, pilot.tree, gather, double(shooting.emitted) / double(pilot.paths), radius};
}

std::vector<Mapped<Photon>> shoot_near(Services& services, const Scene& scene, const Shooting& shooting, const Aim& aim,
                                       const PhotonSpread& spread, float reach) {
    const auto emit = [&](std::size_t shard, std::vector<Photon>& out) {
        shoot_shard(scene, shooting, aim, spread, 0, shard, out);
    };
    auto photons = services.map_near<Photon>(shards_each(shooting), reach, emit,
                                             [](const Photon& photon) { return photon.position; });
    std::size_t count = 0;
    for (const auto& some : photons) count += some.size();
    check_memory(count, shooting);
    return photons;
}

Param beams_param(double initial, const std::string& help) {
    return {.name = "beams",
            .type = ParamType::integer,
            .help = help + "; 0: answers in media are black",
            .initial = Value{initial},
            .least = 0,
            .most = 1e9};
}

Shooting shooting_of_beams(const NodeContext& here, const Shooting& photons) {
    Shooting beams = photons;
    beams.emitted = here.scene().has_media() ? static_cast<std::uint64_t>(here.integer("beams")) : 0;
    beams.key = child(photons.key, key_of("beams"));
    return beams;
}

std::vector<std::shared_ptr<const BeamTree>> take_beams(Services& services, const Scene& scene, const Shooting& beams,
                                                        std::uint64_t first, std::size_t count) {
    const auto aim = take_aim(services, scene, beams, PhotonShooter::Kept::beams);
    const std::size_t each = std::size_t((beams.emitted + beams_per_shard - 1) / beams_per_shard);
    const auto shot = services.map<PhotonBeam>(count * each, [&](std::size_t shard, std::vector<PhotonBeam>& out) {
        const std::uint64_t map = first + shard / each, begin = shard % each * beams_per_shard;
        PhotonShooter(scene, beams.paths, child(beams.key, key_of("ways"), map))
            .shoot_beams(begin, std::min<std::uint64_t>(beams_per_shard, beams.emitted - begin),
                         1 / double(beams.emitted), *aim, out);
    });
    check_memory(shot.size(), sizeof(PhotonBeam), "beams", beams);
    std::vector<std::shared_ptr<const BeamTree>> trees;
    for (std::size_t map = 0; map < count; ++map)
        trees.push_back(services.once<BeamTree>([&] {
            std::vector<PhotonBeam> own;
            for (std::size_t i = map * each; i < (map + 1) * each; ++i)
                own.insert(own.end(), shot.shard(i).begin(), shot.shard(i).end());
            return BeamTree(std::move(own));
        }));
    return trees;
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
