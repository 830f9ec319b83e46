#include "tools/pictures/remix.hpp"

#include <ostream>

#include "core/base/error.hpp"
#include "core/base/own_files.hpp"
#include "core/film/exr.hpp"
#include "core/film/png.hpp"
#include "tools/pictures/output_file.hpp"
#include "tools/pictures/picture_input.hpp"
#include "tools/pictures/picture_lock.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {

Picture read_layers(const std::string& file) {
    Picture picture = layers_of_user(file);
    if (picture.layers.empty()) throw UserError({file, 0}, "has no layers that add up, so there is nothing to mix");
    return picture;
}

void mix_or_complain(Picture& picture, const std::vector<Gain>& gains, const std::string& file) {
    std::vector<std::string> names;
    for (const auto& layer : picture.layers) names.push_back(layer.name);
    std::vector<Problem> problems;
    for (const auto& mistake : mistakes_in(gains, names)) problems.push_back({{file, 0}, mistake});
    if (!problems.empty()) throw UserError(std::move(problems));
    mix(picture, gains);
}

void write_remix(const Picture& picture, const std::string& output, const PngRequest& wanted, std::ostream& err) {
    check_output(output);
    const PictureLock lock(output);
    const auto png = png_beside(output);
    write_exr(output, picture);
    write_png(png, picture, png_view(wanted, brightness_of(picture)));
    err << output << ", " << png.string() << ": ";
    for (std::size_t k = 0; k < picture.layers.size(); ++k)
        err << (k ? ", " : "") << to_string(Gain{picture.layers[k].name, picture.layers[k].gain});
    err << '\n';
    if (picture.overflowed) err << picture.overflowed << " pixels are too bright for this mix, and black in it\n";
}

}  // namespace lightnet
