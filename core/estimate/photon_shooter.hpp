// Sends light from the lamps through the scene, and keeps it where it meets surfaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/estimate/aim.hpp"
#include "core/estimate/photon.hpp"
#include "core/light/mapped.hpp"
#include "core/light/services.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Which photons are kept, by what they met between their lamp and the surface.
enum class PhotonPaths {
    caustic,   // mirrors and glass, at least one of them, and nothing else: LS+D
    diffuse,   // something rough, at least once: L(S|D)*DS*D
    indirect,  // anything: L(S|D)+D
    all        // anything or nothing: L(S|D)*D
};
/// "caustic" and so on. Throws Error on any other word.
PhotonPaths photon_paths(const std::string& name);
/// In Heckbert's notation.
std::string expression_of(PhotonPaths paths);

/// Jensen 2001, "Realistic Image Synthesis Using Photon Mapping", chapter 5. What a way of light meets depends on the
/// key and on its number alone. Any thread may ask.
class PhotonShooter {
public:
    PhotonShooter(const Scene& scene, PhotonPaths paths, Key key) : scene_(scene), paths_(paths), key_(key) {}

    /// Ways `first` … `first + count` of `total`; appends what they leave on surfaces: of all light `share` (1 /
    /// total).
    void shoot(std::uint64_t first, std::size_t count, double share, const Aim& aim, std::vector<Photon>& out) const;
    /// The same ways, as trials.
    void attempt(std::uint64_t first, std::size_t count, const Aim& aim, std::vector<Trial>& out) const;

private:
    struct Walk;
    struct Flock;
    template <class Keep>
    void follow(std::uint64_t first, std::size_t count, float share, const Aim& aim, const Keep& keep,
                std::vector<Trial>* trials) const;
    template <class Keep>
    void visit(Walk walk, const Ray& ray, const Hit& hit, const Keep& keep, Flock& flock) const;
    bool keeps(bool met_mirror, bool met_rough) const;

    const Scene& scene_;
    PhotonPaths paths_;
    Key key_;
};

/// How a map of photons is made: the parameters that nodes share.
struct Shooting {
    PhotonPaths paths = PhotonPaths::caustic;
    std::uint64_t ways = 0;  // of light that leave the lamps
    bool aimed = false;      // rather where they are of use than evenly
    Key key = 0;
    std::size_t most_bytes = 0;  // that may be kept; more is an error
};

/// Learns where to aim, from trials: two rounds on all places. Even, unless it is asked for.
std::shared_ptr<const Aim> take_aim(Services& services, const Scene& scene, const Shooting& shooting);
/// Shoots on all places, so many times anew; photons come in the order of their ways. Shards (see Mapped) of each time
/// stand together: shards_each() of them. Throws Error when that takes more memory than it may.
Mapped<Photon> shoot(Services& services, const Scene& scene, const Shooting& shooting, const Aim& aim,
                     std::size_t times = 1);
std::size_t shards_each(const Shooting& shooting);

/// Shoots once; photons in the order of their ways, but in several memories: where the node is sharded, only those that
/// lie within `reach` (m) of where it may be asked. `most_bytes` bounds what this copy of the node gets.
std::vector<Mapped<Photon>> shoot_near(Services& services, const Scene& scene, const Shooting& shooting, const Aim& aim,
                                       float reach);
/// Points where photons come to lie, about as densely: for Kind::landmarks.
std::vector<Vec3> landmarks_of(const Scene& scene, const Shooting& shooting);

}  // namespace lightnet
