// A check of whether a picture can be seen in its PNG, and the exposure by which it could.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/film/picture.hpp"
#include "core/film/png.hpp"

namespace lightnet {

/// How bright a picture is, by the brightest channel of each pixel. Shares are of all pixels.
struct Brightness {
    double clipped = 0;  // share that is brighter than a PNG can show
    double black = 0;    // share that a PNG shows as black
    double lit = 0;      // share that is brighter than nothing at all
    float high = 0;      // 95 % of the pixels are no brighter
    float lit_high = 0;  // 90 % of those that are lit are no brighter
};

/// Of a picture that is made so many stops brighter.
Brightness brightness_of(const Picture& picture, double stops = 0);

/// More stops by which most of a picture can be seen that is now mostly clipped or mostly black. None: it can be seen
/// already, or no exposure helps, as next to nothing is lit.
std::optional<double> helpful_stops(const Brightness& brightness);

/// How the PNG beside a picture shows it, as users choose it. automatic: with the exposure of helpful_stops(); plain:
/// as it was computed; filmic, aces, agx: with that exposure and such a curve; ocio: with that exposure, by a view of
/// OpenColorIO.
enum class PictureView { automatic, plain, filmic, aces, agx, ocio };

/// "auto", "plain", "filmic", "aces" or "agx".
std::optional<PictureView> picture_view(std::string_view text);

/// What the PNG beside a picture is to be like, as its user says.
struct PngRequest {
    PngRequest(PictureView wanted = PictureView::automatic) : view(wanted) {}  // a view alone says all that most want
    PictureView view;
    std::string ocio{};             // its view, if that is asked for
    std::optional<double> stops{};  // by which it is brighter than the picture; none: as `view` has it
    bool alpha = false;             // it has the picture's alpha, where that has one
};

/// `exposed`: somebody has chosen an exposure for the picture already, which no other is to change.
PngView png_view(const PngRequest& wanted, const Brightness& brightness, bool exposed = false);

/// Most of it is black, and no exposure helps.
bool hardly_lit(const Brightness& brightness);

}  // namespace lightnet
