#include "core/readers/pbrt/pbrt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/readers/common/moment.hpp"
#include "core/readers/files/gzip.hpp"
#include "core/readers/files/other_places.hpp"
#include "core/readers/pbrt/builder.hpp"
#include "core/readers/pbrt/syntax.hpp"
#include "core/readers/pbrt/version.hpp"

namespace lightnet::pbrt {
namespace {

constexpr std::size_t deepest_include = 32;
constexpr int most_includes = 10000;

Bytes unpacked(const Bytes& bytes) {
    return is_gzip(*bytes) ? std::make_shared<const std::vector<std::byte>>(gunzip(*bytes)) : bytes;
}

/// The first sign of a version: in the main file, then in those that it includes, as long as there is none.
std::optional<VersionSign> find_version(Files& files, const std::string& main) {
    constexpr std::size_t most_files = 64;
    struct Named {
        std::string path, from;
    };
    std::vector<Named> names{{main, main}};
    for (std::size_t i = 0; i < names.size() && i < most_files; ++i) {
        const auto [path, from] = names[i];
        try {
            std::vector<std::string> included;
            if (auto sign = version_sign(path, unpacked(files.read(path)), included)) return sign;
            for (const auto& name : included) names.push_back({beside(main, name), path});
        } catch (const MissingHere&) {
            throw;
        } catch (const Error&) {  // told when it is read; where it is then, it is here
            if (const auto others = other_places(files, from, path); i > 0 && !others.empty())
                names.push_back({others[0], others[0]});
        }
    }
    return std::nullopt;
}

/// Goes through the files in the order in which they include each other.
class Walk {
public:
    Walk(const Sources& sources, Builder& builder) : sources_(sources), builder_(builder) {}

    void file(const std::string& name, Bytes bytes) {
        try {
            bytes = unpacked(bytes);
        } catch (const Error& problem) {
            return sources_.report.error({name, 0}, problem.what());
        }
        open_.push_back(name);
        Syntax syntax(name, std::move(bytes), sources_.version, sources_.report);
        while (auto statement = syntax.next()) {
            if (statement->directive == "Include" || statement->directive == "Import")
                include(*statement);
            else
                builder_.execute(*statement);
        }
        open_.pop_back();
    }

private:
    void include(const Statement& statement) {
        const std::string& name = statement.names[0];
        if (open_.size() > deepest_include || ++files_ > most_includes)
            return sources_.report.error(statement.where,
                                         fmt::format("'{}': files include each other too deeply or too often", name));
        const auto found = sources_.find(name, statement.where);
        if (!found) return;
        if (std::find(open_.begin(), open_.end(), found->path) != open_.end())
            return sources_.report.error(statement.where, fmt::format("'{}' includes itself", name));
        if (statement.directive == "Import") builder_.enter();
        file(found->path, found->bytes);
        if (statement.directive == "Import") builder_.leave();
    }

    const Sources& sources_;
    Builder& builder_;
    std::vector<std::string> open_;  // from the main file inwards
    int files_ = 0;
};

/// The one variable of a file is which of the versions it means. None: it is not said.
std::optional<VersionSign> wanted_version(const SceneConstants& constants, const std::string& path) {
    std::optional<VersionSign> wanted;
    for (const auto& [name, value] : constants) {
        if (name != "pbrt")
            throw UserError({path, 0},
                            "pbrt's files have no variables but 'pbrt', which of its versions they mean: there "
                            "is no '" +
                                name + "' to define");
        if (value != "3" && value != "4")
            throw UserError({path, 0},
                            "'pbrt' is the version of pbrt that the file means: 3 or 4, not '" + value + "'");
        wanted = VersionSign{value == "3" ? Version::v3 : Version::v4, {path, 0}, ""};
    }
    return wanted;
}

SceneData read(Files& files, const std::string& path, const SceneConstants& given) {
    SceneConstants constants = given;
    const auto seconds = take_moment(constants, path, "pbrt's motion has");
    auto sign = wanted_version(constants, path);
    const bool told = sign.has_value();
    Report report;
    Bytes bytes;
    try {
        bytes = files.read(path);
    } catch (const Error& problem) {
        throw UserError({path, 0}, fmt::format("can't read the scene: {}", problem.what()));
    }
    if (!told) sign = find_version(files, path);
    const Sources sources{files, path, report, sign ? sign->version : Version::v4};
    if (sources.older() && !told)
        report.warn(sign->where, fmt::format("the scene is read as one of pbrt-v3, of which only that says {}: see "
                                             "docs/pbrt.md for what differs",
                                             sign->text));
    Builder builder(sources, seconds);
    Walk(sources, builder).file(path, bytes);
    builder.finish();
    report.check();
    return builder.take();
}

}  // namespace

SceneFormat format() { return {.endings = {".pbrt"}, .has_variables = true, .moves = true, .read = read}; }

}  // namespace lightnet::pbrt
