// The choice among ways to light a scene, from figures alone: no clock, no picture, no machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/path_kinds.hpp"

namespace lightnet {

/// Which light paths a lighting covers better than path tracing does: those by way of rough surfaces, where paths find
/// light; all of them; those that a mirror or glass casts, also where records would be off; or those along which it
/// pays to learn where light is, which it finds out by itself.
enum class Covers : std::uint8_t { nothing, soft, all, caustics, narrow };

/// What a trial of one way has shown: a small picture with few samples. Errors are relative squares, the mean of d² /
/// (light² + 0.01). A value.
struct LightingTrial {
    std::string name;
    std::string failed{};                 // why there are no figures; "": there are
    std::string foretold{};               // why it is chosen without any; "": it is not
    double pixels = 0, samples = 0;       // of the trial; samples per pixel
    double preparing = 0, rendering = 0;  // processor seconds
    double preparing_grows = 1;           // of the picture that is asked for: so many times as long
    double own_error = 0;                 // that neighbours don't share: falls as 1 / samples
    double shared_error = 0;              // noise of records and photons, and bias
    double shared_falls = 0;              // with samples to the power of minus that; 0: stays
    Covers covers = Covers::nothing;
    LightByKind parts{};  // of its error: light paths of each kind; all 0: not known
};

/// A picture that is asked for.
struct AskedPicture {
    double pixels = 0, samples = 0;  // samples per pixel
};

/// What it is expected to take, and how far it will be off.
struct LightingForecast {
    double seconds = 0, error = 0;  // of processors; relative square
    double cost() const { return seconds * error; }
};
LightingForecast forecast_of(const LightingTrial& trial, const AskedPicture& asked);

/// So many times less error x time is worth a trial.
inline constexpr double least_promise = 2;
/// What the first trial says of the others, by which light paths make its error. A value.
struct LightingPromise {
    Covers covers = Covers::nothing;  // which of them to look at; nothing: path tracing is good
    bool is_clear = false;            // it needs no trial: caches take no longer than leaves it true
    bool else_learns = false;         // where trials show nothing better than path tracing, a guide is to find out
    double times = 0;                 // less error x time than path tracing's, if it prepares in no time
    std::string why;                  // "paths LD+D make 99 % of the error"
    friend bool operator==(const LightingPromise&, const LightingPromise&) = default;
};
/// Caches and maps leave nothing of soft light but what they are off themselves, and make more of the noise of direct
/// light and of gloss, for which they have a quarter of the rays. In doubt, caches are tried. By figures alone that are
/// counted, so that it is the same on every machine.
LightingPromise promise_of(const LightingTrial& first, const AskedPicture& asked, double triangles);

/// The trial whose picture will have the least error × time. The first one stays where no other is better by a tenth:
/// figures of trials are not more exact, and it has no bias. What was foretold is chosen before all. What failed is not
/// chosen, unless all have: then it is the first.
std::size_t best_lighting(const std::vector<LightingTrial>& trials, const AskedPicture& asked);

/// "progressive (error × time 0.12: 8.2 s × 0.0146), path_all (…)": the chosen one first, then the others in their
/// order. The same figures give the same text.
std::string words_of_choice(const std::vector<LightingTrial>& trials, const AskedPicture& asked, std::size_t chosen);

}  // namespace lightnet
