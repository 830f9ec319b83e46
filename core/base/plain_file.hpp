// Files that users name, or that lie where others may put what they like, read as what they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/hash.hpp"

namespace lightnet {

/// A plain file, open for reading, and no larger than the caller can do with. Anything else would have him wait or read
/// for ever: pipes, devices and folders are refused when they are opened, which never waits.
class PlainFile {
public:
    /// Is a name that is a link what it leads to, or no plain file?
    enum class Links { followed, refused };
    /// Throws Error, which names the file and says what it is instead, or how large.
    PlainFile(const std::filesystem::path& path, std::uint64_t most_bytes, Links links = Links::followed);
    ~PlainFile();
    PlainFile(const PlainFile&) = delete;
    PlainFile& operator=(const PlainFile&) = delete;

    std::uint64_t size() const { return size_; }
    /// What is there of the next bytes: fewer only at the end.
    std::size_t read(std::span<std::byte> into);
    void seek(std::uint64_t from_beginning);

    /// All of it. Throws Error when there is no memory for so much, or it ends early.
    std::vector<std::byte> bytes();
    std::string text();

private:
    template <class Content>
    Content content();
    std::string name_;
    int file_ = -1;
    std::uint64_t size_ = 0;
};

/// All of a plain file that is no link; none: it can't be read, or has more than `most` bytes.
std::optional<std::string> text_of_plain_file(const std::filesystem::path& path, std::uint64_t most);
/// The content hash of one; none: it can't be read as a whole.
std::optional<Hash> hash_of_plain_file(const std::filesystem::path& path);

}  // namespace lightnet
