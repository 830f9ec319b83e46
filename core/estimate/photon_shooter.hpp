// Sends light from the lamps through the scene, and keeps it where it meets surfaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/estimate/aim.hpp"
#include "core/estimate/photon.hpp"
#include "core/estimate/photon_beam.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Which photons are kept, by what they met between their lamp and the surface.
enum class PhotonPaths {
    caustic,   // mirrors and glass, at least one of them, and nothing else: LS+(D|V)
    diffuse,   // something rough, at least once: L(S|D|V)*(D|V)S*(D|V)
    indirect,  // anything: L(S|D|V)+(D|V)
    all        // anything or nothing: L(S|D|V)*(D|V)
};
/// "caustic" and so on. Throws Error on any other word.
PhotonPaths photon_paths(const std::string& name);
/// In Heckbert's notation.
std::string expression_of(PhotonPaths paths);

/// DECISIONS: fire-is-scattered-light
/// What media emit counts as scattered by them, as if it had come from the lamps before: no caustic is of it.
///
/// Photon tracing: Jensen 2001, "Realistic Image Synthesis Using Photon Mapping", chapter 5. What a light path meets
/// depends on the key and on its number alone. Any thread may ask.
class PhotonShooter {
public:
    PhotonShooter(const Scene& scene, PhotonPaths paths, Key key);

    /// Paths `first` … `first + count` of `total`; appends what they leave on surfaces: of all light `share` (1 /
    /// total).
    void shoot(std::uint64_t first, std::size_t count, double share, const Aim& aim, std::vector<Photon>& out) const;
    /// Appends what they pass of media, in pieces, each as long as if nothing were scattered on it ("long beams").
    /// What gets farther away than three times the scene's radius is left out.
    void shoot_beams(std::uint64_t first, std::size_t count, double share, const Aim& aim,
                     std::vector<PhotonBeam>& out) const;
    enum class Kept { photons, beams };
    /// Paths `first` … `first + count`, as shoot() follows them; appends a trial for each that leaves something.
    void attempt(std::uint64_t first, std::size_t count, const Aim& aim, std::vector<Trial>& out,
                 Kept what = Kept::photons) const;

private:
    struct PhotonPath;
    struct Batch;
    template <class Keep>
    void follow(std::uint64_t first, std::size_t count, float share, const Aim& aim, const Keep& keep,
                std::vector<Aim::Choice>* chosen) const;
    template <class Keep>
    void visit(PhotonPath path, const Ray& ray, const Hit& hit, const Keep& keep, Batch& batch) const;
    template <class Keep>
    bool cross(PhotonPath& path, const Ray& way, const Keep& keep, Batch& batch) const;
    template <class Keep>
    void leave(PhotonPath path, const Ray& ray, const Keep& keep, Batch& batch) const;
    void go_on(PhotonPath path, const SurfacePoint& point, const Bsdf& bsdf, Vec3 arriving, Batch& batch) const;
    bool keeps(bool met_mirror, bool met_rough) const;
    struct Start;
    std::optional<Start> start(const EmissionNumbers& numbers, ShutterTime time) const;

    const Scene& scene_;
    PhotonPaths paths_;
    Key key_;
    float share_of_media_ = 0;  // of light paths, those that leave media
};

}  // namespace lightnet
