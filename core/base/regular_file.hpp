// A file that is nothing but a file: where others may have put what they like.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "core/base/hash.hpp"

namespace lightnet {

/// A regular file that is open to be read. Its name is no link that leads elsewhere, and no pipe that nobody writes to:
/// of these it says that they can't be read.
class RegularFile {
public:
    explicit RegularFile(const std::filesystem::path& path);
    RegularFile(const RegularFile&) = delete;
    RegularFile& operator=(const RegularFile&) = delete;
    ~RegularFile();

    bool readable() const { return file_ >= 0; }
    /// In bytes, when it was opened.
    std::uint64_t size() const { return size_; }
    /// What comes next, as much as there is room for; fewer bytes: it ends there, or can't be read on.
    std::size_t read(std::span<std::byte> room);

private:
    int file_ = -1;
    std::uint64_t size_ = 0;
};

/// All of such a file; none: it can't be read, or has more than `most` bytes.
std::optional<std::string> text_of_regular_file(const std::filesystem::path& path, std::size_t most);
/// Of what is in such a file; none: it can't be read.
std::optional<Hash> hash_of_regular_file(const std::filesystem::path& path);

}  // namespace lightnet
