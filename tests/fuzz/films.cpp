// Pictures as this project writes them, and the names in them.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/base/error.hpp"
#include "core/base/name_id.hpp"
#include "core/film/exr.hpp"
#include "tests/fuzz/targets.hpp"
#include "tools/pictures/picture_notes.hpp"

namespace lightnet::fuzz {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A file of this process.
const fs::path& film_file() {
    static const auto path = fs::temp_directory_path() / ("lightnet-fuzz-" + std::to_string(getpid()) + ".exr");
    return path;
}

void read_film(std::span<const std::byte> bytes) {
    std::ofstream(film_file(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    try {
        (void)read_exr(film_file());
    } catch (const Error&) {
    }
    fs::remove(film_file());
}

Picture small_picture() {
    Picture picture;
    picture.width = 3, picture.height = 2;
    picture.beauty.assign(6, {1, 2, 3});
    return picture;
}

std::string file_of(const Picture& picture) {
    write_exr(film_file(), picture);
    std::ifstream in(film_file(), std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(in)), {});
    fs::remove(film_file());
    return text;
}

std::vector<std::string> films_of_all_kinds() {
    auto whole = small_picture();
    whole.layers = {{"direct", std::vector<Rgb>(6, {1, 1, 1})}, {"bounce", std::vector<Rgb>(6, {0, 1, 2})}};
    whole.samples.assign(6, 16);
    whole.alpha.assign(6, .5f);
    whole.notes.texts["software"] = "lightnet";
    whole.notes.matrices["worldToCamera"] = {1};
    whole.mattes = {{"things", 2, std::vector<Covered>(12), R"({"ball":"01234567"})"}};
    auto part = small_picture();
    part.x = part.y = 1, part.whole_width = 8, part.whole_height = 4;
    return {file_of(small_picture()), file_of(whole), file_of(part)};
}

void expect(bool holds, const char* what) {
    if (!holds) throw std::logic_error(what);
}

bool is_utf8(const std::string& text) {
    try {
        return !json(text).dump().empty();
    } catch (const json::type_error&) {
        return false;
    }
}

// Lines are names of shapes.
void read_names(std::span<const std::byte> bytes) {
    SceneData scene;
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (std::size_t at = 0; at <= text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        scene.shapes.emplace_back().name = text.substr(at, end - at);
        at = end + 1;
    }
    const auto manifest = manifest_of(scene, NamedBy::object);
    for (const char c : manifest) expect(c >= ' ' && c <= '~', "a manifest is printable ASCII");
    const auto names = json::parse(manifest);
    for (const auto& [name, id] : names.items())
        expect(id.get<std::string>().find_first_not_of("0123456789abcdef") == std::string::npos,
               "an id is hexadecimal");
    for (const auto& shape : scene.shapes)
        if (!shape.name.empty() && is_utf8(shape.name))
            expect(names.at(shape.name) == fmt::format("{:08x}", std::bit_cast<std::uint32_t>(name_id(shape.name))),
                   "a name has its id");
}

std::vector<std::string> some_names() {
    return {"ball\nplate\nball", "Kugel \xc3\xa4\n\"quoted\"\\\n\x01\x7f", "\xff\xfe\n\xed\xa0\x80"};
}

}  // namespace

Target films() { return {"films", read_film, films_of_all_kinds}; }
Target manifests() { return {"manifests", read_names, some_names}; }

}  // namespace lightnet::fuzz
