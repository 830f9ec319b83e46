// Kinds of light paths, by what lies on their way, and what paths of each kind bring.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/math/rgb.hpp"
#include "core/base/query.hpp"

namespace lightnet {

/// How light comes to the rough surface, or the place in a medium, that scatters it to whoever asks.
enum class PathKind : std::uint8_t {
    direct,    // straight from a lamp or the sky
    soft,      // by way of other rough surfaces, of which the last one's lamp is looked for
    glossy,    // a glossy surface has met the lamp, or the sky, by chance
    shining,   // by way of other rough surfaces, and the surface asked about reflects it by a glossy lobe
    caustic,   // a mirror or glass has met the lamp, or the sky, by chance
    mirrored,  // by way of a mirror or glass from a rough surface that is lit
};
inline constexpr std::size_t path_kinds = 6;

/// In Heckbert's notation, from the lamp to where it is asked about; G: glossy, where the others have D for all that is
/// rough.
std::string_view word_of(PathKind kind);

/// What paths bring, kind by kind: luminance. A value.
using LightByKind = std::array<double, path_kinds>;

/// What is known of a path on its way. Each has sums of its own, which follow one another.
namespace told {

inline constexpr std::uint32_t begins = path_kinds, from_gloss = path_kinds + 1;  // from the point by a glossy lobe
inline constexpr std::uint32_t states = path_kinds + 2;  // the others: it would end as one of these kinds
inline constexpr std::uint32_t state_of(PathKind kind) { return static_cast<std::uint32_t>(kind); }

/// It looks for a lamp from the next surface.
inline constexpr std::uint32_t looking(std::uint32_t state) {
    if (state == begins) return state_of(PathKind::direct);
    if (state == from_gloss || state == state_of(PathKind::shining)) return state_of(PathKind::shining);
    return state_of(state == state_of(PathKind::caustic) || state == state_of(PathKind::mirrored) ? PathKind::mirrored
                                                                                                  : PathKind::soft);
}
/// It goes on from the next surface by that lobe.
inline constexpr std::uint32_t gone_on(std::uint32_t state, std::uint8_t lobe) {
    if (lobe == lobe::specular) return state_of(PathKind::caustic);
    if (state == begins) return lobe == lobe::glossy ? from_gloss : state_of(PathKind::direct);
    const std::uint32_t rough = looking(state);
    return lobe == lobe::glossy && rough == state_of(PathKind::soft) ? state_of(PathKind::glossy) : rough;
}
/// What light is that it finds in that state; none in the first: nobody has gone anywhere.
inline constexpr PathKind kind_of(std::uint32_t state) {
    return state < path_kinds ? static_cast<PathKind>(state) : PathKind::direct;
}

/// The place of a path's sum, of so many groups of lamps for each state.
inline constexpr std::uint32_t sum_looking(std::uint32_t sum, std::uint32_t groups) {
    const std::uint32_t state = sum / groups % states;
    return sum + (looking(state) - state) * groups;
}
inline constexpr std::uint32_t sum_gone_on(std::uint32_t sum, std::uint32_t groups, std::uint8_t lobe) {
    const std::uint32_t state = sum / groups % states;
    return sum + (gone_on(state, lobe) - state) * groups;
}

}  // namespace told

/// Where light is added up that a path finds from its next surface on: looking for lamps there, or going on by that
/// lobe. `sums`: of each path.
template <bool tells>
struct PathSums {
    static std::uint32_t beginning(std::uint32_t path, std::uint32_t sums) {
        return path * sums + (tells ? told::begins * (sums / told::states) : 0);
    }
    static std::uint32_t looking(std::uint32_t sum, std::uint32_t sums) {
        return tells ? told::sum_looking(sum, sums / told::states) : sum;
    }
    static std::uint32_t gone_on(std::uint32_t sum, std::uint32_t sums, std::uint8_t lobe) {
        return tells ? told::sum_gone_on(sum, sums / told::states, lobe) : sum;
    }
};

/// As long as it lives, paths of the thread that made it are followed so that their kinds are known: the same paths,
/// whose light may differ in its last bits. One thread's.
class PathKindWatch {
public:
    PathKindWatch();
    ~PathKindWatch();
    PathKindWatch(const PathKindWatch&) = delete;
    PathKindWatch& operator=(const PathKindWatch&) = delete;

    /// Of the calling thread; null: there is none.
    static PathKindWatch* here();

    /// All that paths have brought since the last call, for all questions together.
    LightByKind take();
    /// `sums`: of each question, those of each state in turn, which have as many groups of lamps as an answer.
    void tell(std::span<const Rgb> sums, std::size_t groups, std::span<Rgb> answers);

private:
    PathKindWatch* before_;
    LightByKind found_{};
};

}  // namespace lightnet
