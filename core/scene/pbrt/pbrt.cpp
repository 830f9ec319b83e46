#include "core/scene/pbrt/pbrt.hpp"

#include <fmt/format.h>

#include "core/scene/pbrt/builder.hpp"
#include "core/scene/pbrt/syntax.hpp"

namespace lightnet::pbrt {
namespace {

constexpr int deepest_include = 32;
constexpr int most_includes = 10000;

/// Goes through the files in the order in which they include each other.
class Walk {
public:
    Walk(const Sources& sources, Builder& builder) : sources_(sources), builder_(builder) {}

    void file(const std::string& name, Bytes bytes) {
        Syntax syntax(name, std::move(bytes), sources_.report);
        while (auto statement = syntax.next()) {
            if (statement->directive == "Include" || statement->directive == "Import")
                include(*statement);
            else
                builder_.execute(*statement);
        }
    }

private:
    void include(const Statement& statement) {
        const std::string& name = statement.names[0];
        if (depth_ == deepest_include || ++files_ > most_includes) {
            sources_.report.error(statement.where,
                                  fmt::format("'{}': files include each other too deeply or too often", name));
            return;
        }
        const auto bytes = sources_.read(name, statement.where);
        if (!bytes) return;
        ++depth_;
        if (statement.directive == "Import") builder_.enter();
        file(sources_.path(name), *bytes);
        if (statement.directive == "Import") builder_.leave();
        --depth_;
    }

    const Sources& sources_;
    Builder& builder_;
    int depth_ = 0, files_ = 0;
};

}  // namespace

SceneData read(Files& files, const std::string& path) {
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

}  // namespace lightnet::pbrt
