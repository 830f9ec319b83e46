// Sources of one pbrt scene: files, report, version.
#pragma once

#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "core/base/math/rgb.hpp"
#include "core/readers/common/report.hpp"
#include "core/readers/common/spectra.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/version.hpp"

namespace lightnet::pbrt {

/// The files of a scene. As in pbrt, all names are relative to the folder of the main file.
struct Sources {
    Files& files;
    std::string main;
    Report& report;
    Version version = Version::v4;

    bool older() const { return version == Version::v3; }
    std::string path(const std::string& name) const { return beside(main, name); }
    /// A file that is named, where it is: from the main file's folder, else in other large and small letters, else
    /// beside the file that names it. None: reported; elsewhere than named: warned of.
    struct Found {
        std::string path;
        Bytes bytes;
    };
    std::optional<Found> find(const std::string& name, const SourceLine& where) const;
    /// The bytes of a file that is named at `where`; none: reported.
    std::optional<Bytes> read(const std::string& name, const SourceLine& where) const;
};

/// The light that a parameter of type rgb, spectrum or blackbody stands for. None: reported.
std::optional<LightColour> light_of(const Parameter& parameter, const Sources& sources);

/// What a colour of something that light meets says of it: reflectances are at most 1.
enum class Use { surface, index };
/// What a parameter of type rgb or spectrum stands for. None: reported.
std::optional<SurfaceColour> surface_of(const Parameter& parameter, Use use, const Sources& sources);

}  // namespace lightnet::pbrt
