// What nodes have prepared, kept on the launcher's disk from run to run.
#pragma once

#include <string>
#include <thread>
#include <vector>

#include "core/prepare/prepared.hpp"
#include "transport/blob_cache.hpp"

namespace lightnet {

/// Results are blobs; beside them, in a folder of their own, each recipe names one. Keeping happens in the background.
/// Used by one thread.
class DiskResultCache final : public ResultCache {
public:
    /// Throws Error when the folder can't be made.
    explicit DiskResultCache(const std::string& folder);

    Result find(const Hash& recipe) const override;
    void keep(const Hash& recipe, const Result& result) override;

private:
    BlobCache blobs_;
    std::string recipes_;
    std::vector<std::jthread> keeping_;
};

}  // namespace lightnet
