#include "tools/session/kept_files.hpp"

#include "core/base/atomic_file.hpp"
#include "core/base/own_files.hpp"
#include "core/run/assembly/kept.hpp"

namespace lightnet {

KeptFiles::KeptFiles(const Graph& graph, const Registry& registry, const SceneData& scene) {
    for (const auto& [node, file] : files_to_keep(graph, registry))
        entries_.push_back({node, graph.nodes[node].name, file, registry.find(graph.nodes[node].kind)});
    if (!entries_.empty()) scene_ = identity_of(scene);
}

void KeptFiles::write(const std::function<Bytes(std::size_t node)>& result_of, RunRecorder& book) const {
    for (const auto& [node, name, file, kind] : entries_) {
        const Bytes result = result_of(node);
        if (!result) continue;
        expect_ours(file, kept_beginning);
        write_file(file, kept_text(*kind, scene_, *result));
        book.account().set("kept." + name, file);
        book.account().say(name + ": kept in " + file);
    }
}

}  // namespace lightnet
