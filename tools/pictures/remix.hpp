// Pictures whose layers are mixed anew: shared by `lightnet remix` and `lightnet fit`.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "core/film/gains.hpp"
#include "core/film/picture.hpp"
#include "core/film/tone.hpp"

namespace lightnet {

/// A picture with layers. Throws UserError: it can't be read, or has none.
Picture read_layers(const std::string& file);

/// mix(), whose mistakes are those of the user.
void mix_or_complain(Picture& picture, const std::vector<Gain>& gains, const std::string& file);

/// The picture as a rendering with its gains would be written: `output` and a PNG beside it. Says so in `err`. Throws
/// UserError where other files are in the way, Error when the disk refuses.
void write_remix(const Picture& picture, const std::string& output, const PngRequest& wanted, std::ostream& err);

}  // namespace lightnet
