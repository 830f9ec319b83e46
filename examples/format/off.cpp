// The Object File Format of Geomview, in which much of geometry processing keeps its meshes: OFF, and COFF with colours
// of vertices. A plugin: after this `lightnet render teapot.off` works as it does for formats that lightnet brings.
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/light/plugin.hpp"
#include "core/readers/common/assets.hpp"
#include "core/readers/common/mesh_tools.hpp"
#include "core/readers/common/scene_format.hpp"

namespace off {
namespace {

using namespace lightnet;

/// Words of a text; what stands between '#' and the end of its line is none.
class Words {
public:
    Words(std::string_view text, std::string path) : text_(text), path_(std::move(path)) {}

    std::string_view next(const char* what) {
        skip();
        const auto begin = at_;
        while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
        if (begin == at_) fail(std::string("the file ends where ") + what + " should be");
        return text_.substr(begin, at_ - begin);
    }
    template <class Number>
    Number number(const char* what) {
        const auto word = next(what);
        Number value{};
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size()) fail("'" + std::string(word) + "' is no " + what);
        return value;
    }
    /// Skips what else stands on this line, as colours of faces do. False: nothing.
    bool skip_line() {
        bool something = false;
        for (; at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '#'; ++at_) something |= !is_space(text_[at_]);
        return something;
    }
    SourceLine where() const { return {path_, line_}; }
    [[noreturn]] void fail(const std::string& what) const { throw UserError(where(), what); }

private:
    static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
    void skip() {
        for (bool comment = false; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == '#') comment = true;
            if (!comment && !is_space(c)) return;
            if (c == '\n') comment = false, ++line_;
        }
    }

    std::string_view text_;
    std::string path_;
    std::size_t at_ = 0;
    int line_ = 1;
};

Mesh mesh_in(Words& words, Report& report) {
    const auto kind = words.next("the word OFF");
    if (kind != "OFF" && kind != "COFF") words.fail("a file of this format begins with OFF or COFF");
    const auto vertices = words.number<std::uint32_t>("number of vertices");
    const auto faces = words.number<std::uint32_t>("number of faces");
    words.number<std::uint32_t>("number of edges");
    Mesh mesh;
    const auto coordinate = [&] { return words.number<float>("number"); };
    for (std::uint32_t i = 0; i < vertices; ++i) {
        const float x = coordinate(), y = coordinate(), z = coordinate();
        mesh.positions.push_back({x, y, z});
        if (kind != "COFF") continue;
        const float r = coordinate(), g = coordinate(), b = coordinate();
        coordinate();  // how opaque it is
        if (std::max({r, g, b}) > 1 || std::min({r, g, b}) < 0) words.fail("colours of vertices are of 0 to 1");
        mesh.colours.push_back({r, g, b});
    }
    for (std::uint32_t i = 0; i < faces; ++i) {
        std::vector<std::uint32_t> corners(words.number<std::uint16_t>("number of corners"));
        for (auto& corner : corners)
            if ((corner = words.number<std::uint32_t>("number of a vertex")) >= vertices)
                words.fail("there is no vertex " + std::to_string(corner));
        const auto where = words.where();
        if (words.skip_line()) report.warn(where, "colours of faces are left out");
        triangulate(mesh.positions, corners, [&](auto a, auto b, auto c) { mesh.triangles.push_back({a, b, c}); });
    }
    return mesh;
}

SceneData read(Files& files, const std::string& path, const SceneConstants&) {
    return read_by_assets(files, path, [&](Assets& assets) {
        const auto bytes = assets.read(path, {path, 0});
        if (!bytes) return;
        Words words({reinterpret_cast<const char*>((*bytes)->data()), (*bytes)->size()}, path);
        Mesh mesh = mesh_in(words, assets.report());
        if (mesh.triangles.empty()) words.fail("there are no faces");
        const TextureId colour =
            mesh.colours.empty() ? assets.grey(0.5f) : assets.add({{1, 1, 1}, VertexColour{}, false});
        const MaterialId matt = assets.add(Material{"", DiffuseMaterial{colour}});
        assets.scene().shapes.push_back({std::move(mesh), matt, {}, {path, 0}, stem_of(path)});
    });
}

}  // namespace
}  // namespace off

extern "C" const lightnet::PluginCard* lightnet_plugin() {
    static const lightnet::PluginCard card{
        .name = "off", .version = "1.0", .add_formats = [](std::vector<lightnet::SceneFormat>& formats) {
            formats.push_back({.endings = {".off"}, .read = off::read});
        }};
    return &card;
}
