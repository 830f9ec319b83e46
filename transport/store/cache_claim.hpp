// Claims of processes that share the folder of a cache.
#pragma once

#include <set>
#include <string>

#include "core/base/hash.hpp"

namespace lightnet {

/// A file in the folder that names the blobs which a run needs, held as long as the claim lives, and let go of by the
/// system when its process dies. Whoever makes room leaves these blobs alone. One thread's.
/// DECISIONS: caches-are-claimed
class CacheClaim {
public:
    /// Nothing is claimed yet. Throws nothing: where no file can be made, others don't know.
    explicit CacheClaim(const std::string& folder);
    ~CacheClaim();
    CacheClaim(const CacheClaim&) = delete;
    CacheClaim& operator=(const CacheClaim&) = delete;
    void add(const std::set<Hash>& blobs);

private:
    std::string path_;
    int file_ = -1;
};

/// By all who live. Files of those who don't are removed.
std::set<Hash> claimed_in(const std::string& folder);

}  // namespace lightnet
