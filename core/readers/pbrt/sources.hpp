// What the reader of one pbrt scene reads from.
#pragma once

#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "core/base/math/rgb.hpp"
#include "core/readers/files.hpp"
#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/report.hpp"

namespace lightnet::pbrt {

/// The files of a scene. As in pbrt, all names are relative to the folder of the main file.
struct Sources {
    Files& files;
    std::string main;
    Report& report;

    std::string path(const std::string& name) const { return beside(main, name); }
    /// The bytes of a file that is named at `where`; none: reported.
    std::optional<Bytes> read(const std::string& name, const SourceLine& where) const;
};

/// What a colour is for: the same spectrum is another RGB as a surface than as a lamp.
enum class Use { surface, index, light };

/// The colour that a parameter of type rgb, spectrum or blackbody stands for. None: reported.
std::optional<Rgb> colour_of(const Parameter& parameter, Use use, const Sources& sources);

}  // namespace lightnet::pbrt
