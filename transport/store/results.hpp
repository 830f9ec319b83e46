// Results of preparing, as a host has them.
#pragma once

#include <cstddef>
#include <deque>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/base/hash.hpp"
#include "transport/store/blob_cache.hpp"

namespace lightnet {

/// All are in the cache on disk; in memory are those that some place still looks at, and the latest ones, which are
/// about to be asked for. Any thread.
class Results {
public:
    /// `cache` must outlive it. Keeps the latest up to so many bytes, but at least one.
    explicit Results(const BlobCache& cache, std::size_t most_bytes = std::size_t{16} << 20)
        : cache_(cache), most_bytes_(most_bytes) {}

    /// One that the cache has.
    void take(const Hash& name, Bytes bytes);
    /// One that it is to have, as room was made for it: written by a thread of its own, and held until it is on disk.
    void keep(const Hash& name, Bytes bytes);
    bool in_memory(const Hash& name) const;
    /// What the cache has, whoever put it there; null: it has none.
    Bytes read(const Hash& name) const { return cache_.read(name); }
    /// Null when the cache has lost it.
    Bytes find(const Hash& name);

private:
    const BlobCache& cache_;
    std::size_t most_bytes_;
    mutable std::mutex mutex_;
    std::map<Hash, std::weak_ptr<const std::vector<std::byte>>> all_;
    std::deque<Bytes> latest_;
    std::size_t latest_bytes_ = 0;
    std::vector<std::pair<Bytes, std::shared_future<bool>>> writing_;  // those that the disk refuses stay
};

}  // namespace lightnet
