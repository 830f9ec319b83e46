#include "tools/pictures/picture_input.hpp"

#include <string_view>

#include "core/base/error.hpp"
#include "core/base/own_files.hpp"
#include "core/film/exr.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/images/image_file.hpp"

namespace lightnet {
namespace {

template <class Read>
Picture of_user(const std::string& file, const Read& read) try {
    return read(file);
} catch (const Error& error) {
    std::string_view what = error.what();
    if (what.starts_with(file + ": ")) what.remove_prefix(file.size() + 2);
    throw UserError({file, 0}, "can't be read: " + std::string(what));
}

}  // namespace

Picture picture_in(const std::string& path) {
    if (has_ending(path, ".exr")) return read_exr(path);
    DiskFiles files;
    try {
        expect_image(files.beginning(path, image_beginning));
    } catch (const Error& error) {
        throw Error(std::string(error.what()).starts_with(path) ? error.what() : path + ": " + error.what());
    }
    const Bytes bytes = files.read(path);
    try {
        const Image image = read_image(*bytes);
        Picture picture{image.width, image.height, {}, {}};
        for (std::uint32_t y = 0; y < image.height; ++y)
            for (std::uint32_t x = 0; x < image.width; ++x) picture.beauty.push_back(image.colour(x, y));
        return picture;
    } catch (const Error& error) {
        throw Error(path, error.what());
    }
}

Picture picture_of_user(const std::string& file) { return of_user(file, picture_in); }

Picture layers_of_user(const std::string& file) { return of_user(file, read_exr); }

}  // namespace lightnet
