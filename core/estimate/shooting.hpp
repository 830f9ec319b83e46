// Photon shooting, as nodes ask for it: its parameters, and the work on all places.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/estimate/beam_tree.hpp"
#include "core/estimate/photon_shooter.hpp"
#include "core/estimate/photon_spread.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/mapped.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/services.hpp"

namespace lightnet {

/// How a map of photons is made: the parameters that nodes share.
struct Shooting {
    PhotonPaths paths = PhotonPaths::caustic;
    std::uint64_t emitted = 0;  // light paths that leave the lamps
    bool aimed = false;         // where they are of use, rather than everywhere alike
    Key key = 0;
    std::size_t most_bytes = 0;     // that may be kept; more is an error. Of this machine, where the graph says nothing
    std::size_t planned_bytes = 0;  // that an `error` may lead to: the same on every machine
    double error = 0;               // that decides how many are emitted, where nobody says so: emitted is 0

    /// As the node's parameters say: shooting_params().
    static Shooting of(const NodeContext& here);
    /// As the parameters of a node say where an `error` may decide how many are emitted.
    static Shooting with_error(const NodeContext& here);
};

/// Parameters `photons`, `paths`, `aim` and `memory` for the schema of a kind. Where `photons` is 0 by itself, it has
/// an `error`, too.
std::vector<Param> shooting_params(double photons, const std::string& help_of_photons);
/// The parameter `radius` of nodes that gather photons; 0: a twentieth of the scene's radius.
Param gather_radius(const std::string& help);
float gather_radius(const NodeContext& here);

/// Light paths that such a node counts: for LightTraits::paths.
std::vector<std::string> paths_of_photons(const Node& node);

/// Could any photon be kept? False is certain: nothing in the scene makes caustics.
bool may_keep_any(const Scene& scene, PhotonPaths paths);
/// Learns where to aim, from trials: two rounds on all places. Even, unless it is asked for.
std::shared_ptr<const Aim> take_aim(Services& services, const Scene& scene, const Shooting& shooting,
                                    PhotonShooter::Kept what = PhotonShooter::Kept::photons);
/// Some of the maps that can be shot anew without end, each of other photons, which are spread in discs of its radius.
struct PhotonMaps {
    std::uint64_t first = 0;
    std::span<const float> radii;  // m
};
/// Shoots these on all places, and spreads; photons come in the order of their paths. Shards (see Mapped) of each map
/// stand together: shards_each() of them. Throws Error when that takes more memory than it may.
Mapped<Photon> shoot(Services& services, const Scene& scene, const Shooting& shooting, const Aim& aim,
                     const PhotonMaps& maps);
std::size_t shards_each(const Shooting& shooting);

/// How photons are spread that the node has had sent, in discs of `gather` photons, no larger than `radius` (m): from
/// some first ones, on all places. Where nobody says how many light paths are emitted, this decides it.
///
/// As many that a part of the scene that gets a hundredth of them has them with the wanted error, of noise (1 / √n);
/// and that discs lie off their surfaces by no more than its root. That part of their light is given back, so that what
/// is left is of second order.
PhotonSpread take_spread(Services& services, const Scene& scene, Shooting& shooting, const Aim& aim, std::size_t gather,
                         float radius);

/// Shoots once, and spreads; photons in the order of their paths, but in several memories: where the node is sharded,
/// only those that lie within `reach` (m) of where it may be asked. `most_bytes` bounds what this copy of the node
/// gets.
std::vector<Mapped<Photon>> shoot_near(Services& services, const Scene& scene, const Shooting& shooting, const Aim& aim,
                                       const PhotonSpread& spread, float reach);
/// The parameter `beams` of nodes that answer at points in media, too: light paths that leave the lamps for that.
Param beams_param(double initial, const std::string& help);
/// As the node's parameters say: how its beams are shot, none where the scene has no media.
Shooting shooting_of_beams(const NodeContext& here, const Shooting& photons);
/// Shoots `count` maps of beams on all places, from map `first` on, each of other light paths, where they are of use.
/// Throws Error when that takes more memory than photons may.
std::vector<std::shared_ptr<const BeamTree>> take_beams(Services& services, const Scene& scene, const Shooting& beams,
                                                        std::uint64_t first = 0, std::size_t count = 1);
/// Points where photons come to lie, about as densely: for RunTraits::landmarks.
std::vector<Vec3> landmarks_of(const Scene& scene, const Shooting& shooting);

}  // namespace lightnet
