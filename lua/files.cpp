#include "lua/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/base/error.hpp"

namespace lightnet::lua {
namespace {

constexpr std::size_t most_bytes = std::size_t{4} << 20;

std::string text_from(int descriptor) {
    std::string text;
    std::array<char, 65536> buffer;
    for (ssize_t size = 0; (size = ::read(descriptor, buffer.data(), buffer.size())) != 0;) {
        if (size < 0 && errno == EINTR) continue;
        if (size < 0) throw Error(std::strerror(errno));
        text.append(buffer.data(), static_cast<std::size_t>(size));
        if (text.size() > most_bytes) throw Error("longer than 4 MiB");
    }
    return text;
}

/// A plain file, open for reading.
class OpenFile {
public:
    // without O_NONBLOCK a named pipe would make us wait for its writer
    explicit OpenFile(const std::string& path) : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
        if (number_ < 0) throw Error(std::strerror(errno));
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile() { ::close(number_); }

    std::string text() const {
        struct stat facts {};
        if (::fstat(number_, &facts) != 0) throw Error(std::strerror(errno));
        if (!S_ISREG(facts.st_mode)) throw Error("not a plain file");
        return text_from(number_);
    }

    // Asked of the open file, so that nobody can swap a link between the question and the reading.
    std::filesystem::path real_path() const {
        return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(number_));
    }

private:
    int number_;
};

}  // namespace

std::string read_text(const std::string& file) { return OpenFile(file).text(); }

std::string read_standard_input() { return text_from(STDIN_FILENO); }

std::string read_text_inside(const std::string& folder, const std::string& path) {
    const OpenFile file(path);
    const std::string inside = (std::filesystem::canonical(folder) / "").string();
    if (!file.real_path().string().starts_with(inside)) throw Error("lies outside of the graph's folder");
    return file.text();
}

}  // namespace lightnet::lua
