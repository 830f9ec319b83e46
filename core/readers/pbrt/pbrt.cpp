#include "core/readers/pbrt/pbrt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "core/readers/gzip.hpp"
#include "core/readers/pbrt/builder.hpp"
#include "core/readers/pbrt/syntax.hpp"

namespace lightnet::pbrt {
namespace {

constexpr std::size_t deepest_include = 32;
constexpr int most_includes = 10000;

/// Goes through the files in the order in which they include each other.
class Walk {
public:
    Walk(const Sources& sources, Builder& builder) : sources_(sources), builder_(builder) {}

    void file(const std::string& name, Bytes bytes) {
        if (is_gzip(*bytes)) try {
                bytes = std::make_shared<const std::vector<std::byte>>(gunzip(*bytes));
            } catch (const Error& problem) {
                return sources_.report.error({name, 0}, problem.what());
            }
        open_.push_back(name);
        Syntax syntax(name, std::move(bytes), sources_.report);
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
        const std::string path = sources_.path(name);
        if (std::find(open_.begin(), open_.end(), path) != open_.end())
            return sources_.report.error(statement.where, fmt::format("'{}' includes itself", name));
        if (open_.size() > deepest_include || ++files_ > most_includes)
            return sources_.report.error(statement.where,
                                         fmt::format("'{}': files include each other too deeply or too often", name));
        const auto bytes = sources_.read(name, statement.where);
        if (!bytes) return;
        if (statement.directive == "Import") builder_.enter();
        file(path, *bytes);
        if (statement.directive == "Import") builder_.leave();
    }

    const Sources& sources_;
    Builder& builder_;
    std::vector<std::string> open_;  // from the main file inwards
    int files_ = 0;
};

SceneData read(Files& files, const std::string& path, const SceneConstants&) {
    Report report;
    const Sources sources{files, path, report};
    Builder builder(sources);
    Bytes bytes;
    try {
        bytes = files.read(path);
    } catch (const Error& problem) {
        throw UserError({path, 0}, fmt::format("can't read the scene: {}", problem.what()));
    }
    Walk(sources, builder).file(path, bytes);
    builder.finish();
    report.check();
    return builder.take();
}

}  // namespace

SceneFormat format() { return {.endings = {".pbrt"}, .read = read}; }

}  // namespace lightnet::pbrt
