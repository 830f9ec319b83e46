// Results of preparing, kept on the launcher's disk from run to run.
#pragma once

#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "core/run/assembly/prepared.hpp"
#include "core/run/message/tuning.hpp"
#include "transport/store/blob_cache.hpp"

namespace lightnet {

/// Results are blobs; beside them, in a folder of their own, each recipe names one. Keeping happens in the background.
/// What is larger than the folder may be is not kept. Used by one thread.
class DiskResultCache final : public ResultCache {
public:
    /// Throws Error when the folder can't be made, or is no cache: see open_cache_folder().
    explicit DiskResultCache(const std::string& folder, std::uint64_t most_bytes = usual_cache_size);
    ~DiskResultCache() override;

    Result find(const Hash& recipe) const override;
    void keep(const Hash& recipe, const Result& result) override;

private:
    BlobCache blobs_;
    std::string recipes_;
    std::vector<std::jthread> keeping_;
};

}  // namespace lightnet
