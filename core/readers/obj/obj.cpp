#include "core/readers/obj/obj.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/common/assets.hpp"
#include "core/readers/common/mesh_tools.hpp"
#include "core/readers/files/trimmed.hpp"
#include "core/readers/obj/elsewhere.hpp"
#include "core/readers/obj/materials.hpp"
#include "core/readers/obj/model.hpp"

namespace lightnet::obj {
namespace {

/// Finds materials by name; those that are missing are reported once, and grey.
class Palette {
public:
    explicit Palette(Assets& assets) : assets_(assets) {}

    std::map<std::string, Surface>& all() { return materials_; }

    const Surface& of(const Part& part) {
        if (const auto known = find(part.material); known != materials_.end()) return known->second;
        if (!part.material.empty()) {
            std::vector<std::string> names;
            for (const auto& [name, surface] : materials_) names.push_back(name);
            assets_.report().warn(part.where, fmt::format("there is no material '{}'{}: grey is taken", part.material,
                                                          did_you_mean(part.material, names)));
        }
        Surface grey;
        const bool painted = !part.mesh.colours.empty();
        grey.material = assets_.add(Material{
            part.material,
            DiffuseMaterial{painted ? assets_.add(Texture{{1, 1, 1}, VertexColour{}, false}) : assets_.grey(0.5f)}});
        return painted ? (painted_ = grey) : materials_.emplace(part.material, grey).first->second;
    }

private:
    /// By the whole of its line, or by what stands there before a remark.
    std::map<std::string, Surface>::iterator find(const std::string& name) {
        const auto known = materials_.find(name);
        const auto remark = std::min(name.find(" #"), name.find("\t#"));
        if (known != materials_.end() || remark == name.npos) return known;
        return materials_.find(std::string(trimmed(name.substr(0, remark), " \t")));
    }

    Assets& assets_;
    std::map<std::string, Surface> materials_;
    Surface painted_;
};

/// The words of a line, up to a remark.
std::vector<std::string_view> words_of(std::string_view line) {
    constexpr std::string_view blanks = " \t";
    std::vector<std::string_view> words;
    for (std::size_t at = line.find_first_not_of(blanks); at < line.size() && line[at] != '#';) {
        const auto end = std::min(line.find_first_of(blanks, at), line.size());
        words.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(blanks, end);
    }
    return words;
}

bool is_whole_name(std::string_view word) {
    return word.size() > 4 && same_but_for_case(word.substr(word.size() - 4), ".mtl");
}

/// The libraries that a line names: the name of each may have blanks, and the longest that is there counts.
class LibraryLine {
public:
    LibraryLine(const Library& line, const std::string& path, Assets& assets)
        : line_(line), path_(path), assets_(assets), words_(words_of(line.name)) {}

    void read(Palette& palette) {
        if (words_.empty()) missing("");
        for (std::size_t begin = 0, end = 0; begin < words_.size(); begin = end) {
            end = begin + 1;
            if (const auto found = find(begin, end))
                read_materials(*found, line_.where, assets_, palette.all());
            else
                missing(joined(begin, end));
        }
    }

private:
    std::string joined(std::size_t begin, std::size_t end) const {
        return {words_[begin].data(), words_[end - 1].data() + words_[end - 1].size()};
    }

    /// The one whose name begins there; `end`: behind it.
    std::optional<std::string> find(std::size_t begin, std::size_t& end) {
        constexpr std::size_t most_in_a_name = 16;
        const std::size_t most = std::min(words_.size(), begin + most_in_a_name);
        for (std::size_t last = most; last > begin; --last)
            if (auto whole = beside(path_, joined(begin, last)); assets_.exists(whole)) {
                end = last;
                return whole;
            }
        // what is called otherwise ends where a name seems to end
        for (std::size_t last = begin; last < most; ++last)
            if (is_whole_name(words_[last])) {
                end = last + 1;
                return find_library(path_, joined(begin, end), line_.where, assets_);
            }
        return std::nullopt;
    }

    // shapes without their colours are better than none
    void missing(const std::string& name) {
        assets_.report().warn(line_.where, fmt::format("there is no material library '{}': grey is taken", name));
    }

    const Library& line_;
    const std::string& path_;
    Assets& assets_;
    std::vector<std::string_view> words_;
};

std::vector<Subdivision> subdivisions_of(const SceneConstants& constants, const std::string& path) {
    constexpr int most = 8;
    std::vector<Subdivision> wanted;
    for (const auto& [name, value] : constants) {
        const auto object = name.substr(subdivision_constant.size());
        if (value.size() != 1 || value[0] < '0' || value[0] > '0' + most)
            throw UserError({path, 0}, fmt::format("'subdivision' of '{}' must be a whole number from 0 to {}, not {}",
                                                   object, most, value));
        wanted.push_back({object, value[0] - '0'});
    }
    return wanted;
}

SceneData read(Files& files, const std::string& path, const SceneConstants& constants) {
    const auto subdivided = subdivisions_of(constants, path);
    return read_by_assets(files, path, [&](Assets& assets) {
        Report& report = assets.report();
        SceneData& scene = assets.scene();
        const auto bytes = assets.read(path, {path, 0});
        report.check();
        Model model = read_model(**bytes, path, Cut::by_material, report, subdivided);
        Palette palette(assets);
        for (const Library& line : model.libraries) LibraryLine(line, path, assets).read(palette);
        for (auto& part : model.parts) {
            const Surface surface = palette.of(part);
            if (part.mesh.normals.empty() && part.smooth)
                smooth_normals(part.mesh);
            else if (!part.mesh.normals.empty())
                order_by_normals(part.mesh);
            scene.shapes.push_back({std::move(part.mesh), surface.material, surface.emission, part.where, part.object});
        }
        if (scene.shapes.empty() && report.good()) report.error({path, 0}, "there are no faces");
    });
}

}  // namespace

SceneFormat format() { return {.endings = {".obj"}, .subdivides = true, .read = read}; }

}  // namespace lightnet::obj
