// Pictures as OpenEXR files.
#pragma once

#include <filesystem>
#include <string>

#include "core/film/picture.hpp"

namespace lightnet {

/// The bytes of an OpenEXR file of `picture`: one part; channels R, G, B are the beauty, `NAME.R`, `NAME.G`, `NAME.B`
/// each layer (for what is shown beside them as PictureLayer::letters says), `A` the alpha (where it is known),
/// `samples` (where their number differs) the samples of each pixel, `NAME00.R` … the mattes by the specification of
/// Cryptomatte (1.2). All are float32, but what is shown beside the sum has half floats if the picture's storage says
/// so, which also names the compression. The attribute "layers" names the layers in the order in which they add up;
/// "gains", where they are not all 1, has three numbers for each, times which it is in the beauty. The layers
/// themselves are without them. Notes are attributes of their names. Its colours are said to be those of BT.709,
/// scene-linear ("chromaticities", "colorInteropID"). The display window is the whole picture, the data window what of
/// it is there. A preview says how much of it is done in the attribute "done". The same picture gives the same bytes:
/// nothing of when, where or by whom it was made is in them.
std::string exr_of(const Picture& picture);

/// Writes it, whole or not at all. Throws Error.
void write_exr(const std::filesystem::path& path, const Picture& picture);

/// Reads R, G, B (half or float) and all else that exr_of() writes, as far as the file has it. Throws Error.
Picture read_exr(const std::filesystem::path& path);

}  // namespace lightnet
