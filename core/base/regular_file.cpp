#include "core/base/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>
#include <vector>

namespace lightnet {

RegularFile::RegularFile(const std::filesystem::path& path)
    : file_(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {
    struct stat about {};
    if (file_ >= 0 && (::fstat(file_, &about) != 0 || !S_ISREG(about.st_mode))) ::close(std::exchange(file_, -1));
    size_ = static_cast<std::uint64_t>(about.st_size);
}

RegularFile::~RegularFile() {
    if (file_ >= 0) ::close(file_);
}

std::size_t RegularFile::read(std::span<std::byte> room) {
    std::size_t filled = 0;
    while (filled < room.size()) {
        const auto size = ::read(file_, room.data() + filled, room.size() - filled);
        if (size < 0 && errno == EINTR) continue;
        if (size <= 0) break;
        filled += static_cast<std::size_t>(size);
    }
    return filled;
}

std::optional<std::string> text_of_regular_file(const std::filesystem::path& path, std::size_t most) {
    RegularFile file(path);
    if (!file.readable() || file.size() > most) return std::nullopt;
    std::string text(most + 1, '\0');  // one that grows is noticed
    text.resize(file.read(std::as_writable_bytes(std::span(text))));
    return text.size() > most ? std::nullopt : std::optional(std::move(text));
}

std::optional<Hash> hash_of_regular_file(const std::filesystem::path& path) {
    RegularFile file(path);
    if (!file.readable()) return std::nullopt;
    Hasher hasher;
    std::uint64_t sum = 0;
    std::vector<std::byte> room(std::size_t{1} << 20);
    while (const auto size = file.read(room)) {
        hasher.add(std::span(room).first(size));
        sum += size;
    }
    return sum == file.size() ? std::optional(hasher.finish()) : std::nullopt;
}

}  // namespace lightnet
