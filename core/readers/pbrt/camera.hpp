// pbrt's camera and film.
#pragma once

#include <string>

#include "core/base/math/transform.hpp"
#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/version.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// A camera, and when its shutter is open.
struct Shot {
    CameraData camera;
    ShutterSpan shutter;
    float exposure = 1;  // seconds
};

/// All but where it stands: the inverse of the transform at the Camera statement.
Shot make_camera(const std::string& type, Parameters& parameters, Version version);

/// Makes the axes of a camera's transform unit vectors, and its lens and screen as large as they were.
void take_scale_out(CameraData& camera);

/// A film, and the light that it shows as white.
struct FilmShot {
    FilmData film;
    Rgb white{1, 1, 1};  // luminance 1
};

/// The film, its scale without the exposure time: with a sensor of ISO 100 and one second a light of `rgb L` [l l l],
/// seen directly, has the value l. In pbrt-v3 it has that with any shutter.
FilmShot make_film(const std::string& type, Parameters& parameters, Version version);

}  // namespace lightnet::pbrt
