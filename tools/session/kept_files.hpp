// Files in which nodes want what they have learnt kept for later runs.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/base/hash.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/scene/data/scene_data.hpp"
#include "tools/session/run_recorder.hpp"

namespace lightnet {

class KeptFiles {
public:
    /// Of a checked graph. `scene` is what its nodes learn it of.
    KeptFiles(const Graph& graph, const Registry& registry, const SceneData& scene);

    /// Writes them, and says so in the book; `result_of` gives what a node has learnt. Throws Error, also when files of
    /// others are there.
    void write(const std::function<Bytes(std::size_t node)>& result_of, RunRecorder& book) const;

private:
    struct Entry {
        std::size_t node = 0;
        std::string name, file;
        const Kind* kind = nullptr;
    };
    std::vector<Entry> entries_;
    Hash scene_;
};

}  // namespace lightnet
