// Content-addressed storage: bytes named by their hash, kept on the worker's disk from run to run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "core/base/hash.hpp"
#include "core/readers/files/files.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/message/tuning.hpp"
#include "transport/store/arriving_bytes.hpp"
#include "transport/store/cache_claim.hpp"
#include "transport/store/cache_folder.hpp"

namespace lightnet {

/// A folder of blobs, one file each, named by hash. Several processes may share it: files appear by renaming, and what
/// is read is verified. Any thread.
class BlobCache {
public:
    /// A blob on its way in.
    class Incoming {
    public:
        ~Incoming();
        Incoming(Incoming&& other) noexcept;
        std::uint64_t here() const { return pieces_.here(); }
        /// A piece, as ArrivingBytes takes it. True: it is whole, and in the cache. Throws Error when the disk refuses,
        /// and when it is longer than it was said to be, or is not what its name says.
        bool take(std::uint64_t offset, std::span<const std::byte> piece);

    private:
        friend class BlobCache;
        void write(std::span<const std::byte> piece);
        void appear();
        Incoming(std::string path, const Hash& hash, std::uint64_t size);
        std::string path_, partial_;  // partial_ empty: nothing to remove
        ArrivingBytes pieces_;
        std::ofstream file_;
    };

    /// Opens the folder: see open_cache_folder().
    explicit BlobCache(std::string folder, std::uint64_t most_bytes = usual_cache_size);

    bool has(const Hash& hash) const;
    /// The blob, verified: a damaged one is removed and none is given.
    Bytes read(const Hash& hash) const;
    /// Room for a blob of `size` bytes that comes in pieces. It is not synced: what is read is verified, and can be
    /// sent again.
    Incoming receive(const Hash& hash, std::uint64_t size) const;
    /// Stores a blob that is what its name says. Throws Error when the disk refuses.
    void store(const Hash& hash, std::span<const std::byte> blob) const;
    /// Removes the blobs and recipes that were not read for the longest time until the folder is within its limit, and
    /// recipes of blobs that are gone. Other files stay, and so do blobs that somebody claims, see CacheClaim; they do
    /// not count. Throws nothing.
    void trim() const { make_room(0); }
    /// Trims until there is room for so many bytes more.
    void make_room(std::uint64_t bytes) const;
    std::uint64_t most_bytes() const { return most_bytes_; }
    /// For a run that is going to need blobs.
    CacheClaim claim() const;

private:
    std::string path_of(const Hash& hash) const;
    std::string folder_;
    CacheMark mark_;
    std::uint64_t most_bytes_;
};

/// The files of a job, read from a cache instead of the user's disk.
class BlobFiles final : public Files {
public:
    BlobFiles(const BlobCache& cache, const std::vector<JobFile>& files) : cache_(cache), files_(files) {}
    Bytes read(const std::string& path) override;
    std::optional<std::string> like(const std::string& path) override;

private:
    const BlobCache& cache_;
    const std::vector<JobFile>& files_;
};

}  // namespace lightnet
