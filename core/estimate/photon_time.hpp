// Times at which photons came, and which of them count for a question.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/math/shutter.hpp"

namespace lightnet {

struct Query;
class Scene;

/// When a photon came, and to what. Only of scenes in which something moves: elsewhere nobody reads it.
struct PhotonTime {
    std::uint32_t instant = 0;   // one of `instants`, evenly spaced while the shutter is open
    bool on_what_moves = false;  // else its surface stands still

    static constexpr std::uint32_t instants = 512;
    static std::uint32_t instant_of(ShutterTime time) { return time / step; }
    /// Exactly when all light of that instant is on its way.
    static ShutterTime middle_of(std::uint32_t instant) { return ShutterTime(instant * step + step / 2); }

    ShutterTime time() const { return middle_of(instant); }

private:
    static constexpr std::uint32_t step = 65536 / instants;
};

/// The instants whose photons count: a box kernel in time. It ends where the shutter opens and closes, and who gathers
/// divides by what is left of it.
struct PhotonWindow {
    std::uint32_t first = 0, count = PhotonTime::instants;

    /// Of so wide a part of the shutter's time around one of them; at least that one.
    static PhotonWindow around(std::uint32_t instant, float width) {
        constexpr std::uint32_t all = PhotonTime::instants;
        const auto half = std::uint32_t(std::clamp(width, 0.0f, 2.0f) * (all / 2));
        const std::uint32_t first = instant - std::min(half, instant), end = std::min(all, instant + half + 1);
        return {first, end - first};
    }

    bool whole() const { return count == PhotonTime::instants; }
    bool has(std::uint32_t instant) const { return instant - first < count; }
    /// Of the time for which the shutter is open.
    float part() const { return float(count) / float(PhotonTime::instants); }
};

/// How wide windows are: a part of the shutter's time.
// DECISIONS: photons-near-in-time
inline constexpr float photon_window = 1.0f / 16;

/// Whose photons count for a question. What moves takes those that came at about its time, as others lie where it is
/// not; on what stands still all count, as light on it is the same on average.
PhotonWindow window_of(const Scene& scene, const Query& question, float width);
/// Of who asks where a photon lies, when it came there.
inline PhotonWindow window_of(PhotonTime time, float width) {
    return time.on_what_moves ? PhotonWindow::around(time.instant, width) : PhotonWindow{};
}

}  // namespace lightnet
