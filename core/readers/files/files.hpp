// The source of a scene's bytes: a disk, or blobs that were sent.
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/base/error.hpp"
#include "core/base/hash.hpp"

namespace lightnet {

class ThreadPool;

/// A file that is known to be there, or memory for what is in it, is missing on this machine: nobody may go on as
/// though there were none, or hosts would render different pictures.
class MissingHere final : public Error {
public:
    using Error::Error;
};

/// A tree of files, by path. Readers of scenes open files only through it, so that a host without the user's disk can
/// read the very same scene. One thread at a time.
class Files {
public:
    virtual ~Files() = default;
    /// The whole file. Throws Error when there is none or it can't be read.
    virtual Bytes read(const std::string& path) = 0;
    /// The first bytes of it, `most` at most: so much is looked at before a large file is read for nothing.
    virtual std::vector<std::byte> beginning(const std::string& path, std::size_t most);
    /// A file whose path differs from `path` at most by large and small letters, the first of several.
    virtual std::optional<std::string> like(const std::string& path) = 0;
    /// Where a file really lies: as it is named, or, on a disk, where links lead.
    virtual std::string real_path(const std::string& path) const { return path; }
};

/// The disk. Remembers what was read, so that it can be sent: path → bytes.
class DiskFiles final : public Files {
public:
    DiskFiles();
    ~DiskFiles() override;
    Bytes read(const std::string& path) override;
    std::vector<std::byte> beginning(const std::string& path, std::size_t most) override;
    std::optional<std::string> like(const std::string& path) override;
    std::string real_path(const std::string& path) const override;
    const std::map<std::string, Bytes>& seen() const { return seen_; }
    /// Of all that was read: computed on the side while the reader went on.
    std::map<std::string, Hash> hashes();

private:
    std::map<std::string, Bytes> seen_;
    std::atomic<bool> ended_{false};           // nobody wants hashes any more
    std::map<std::string, Hash> hashes_;       // its entries stay where they are
    std::unique_ptr<ThreadPool> thread_pool_;  // last: it writes into the others
};

/// Are they the same but for large and small letters (of ASCII)?
bool same_but_for_case(std::string_view a, std::string_view b);
/// `path` as written inside the file `from`: relative to the folder of `from`, unless absolute. Without "." and "..".
std::string beside(const std::string& from, const std::string& path);
/// Does `path` lie in `folder`, or below? By their names alone.
bool lies_within(const std::string& folder, const std::string& path);
/// Does the file at `path` lie in the folder of the file `from`, or below, as it is named and really?
bool stays_beside(const Files& files, const std::string& from, const std::string& path);
/// The name of a file without its folder and its ending: what a shape goes by that has a file of its own.
std::string stem_of(const std::string& path);

}  // namespace lightnet
