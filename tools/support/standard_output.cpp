#include "tools/support/standard_output.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <streambuf>
#include <string_view>
#include <system_error>

#include "tools/support/exit_code.hpp"

namespace lightnet {

void keep_standard_descriptors() {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
        // the lowest that is free is this one; nobody can write to standard output then, and is told
        const int taken = ::open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY);
        if (taken > STDERR_FILENO) ::close(taken);
    }
}

// The library's own buffer keeps neither what it couldn't write nor why.
class StandardOutput::Bytes final : public std::streambuf {
public:
    Bytes() : replaced_(std::cout.rdbuf(this)) {}
    ~Bytes() override {
        write_all();
        std::cout.rdbuf(replaced_);
    }
    Bytes(const Bytes&) = delete;
    Bytes& operator=(const Bytes&) = delete;

    bool write_all() {
        std::string_view left = waiting_;
        while (!left.empty() && !error_) {
            const auto written = ::write(STDOUT_FILENO, left.data(), left.size());
            if (written >= 0)
                left.remove_prefix(static_cast<std::size_t>(written));
            else if (errno == EAGAIN)
                wait_for_room();
            else if (errno != EINTR)
                error_ = errno;
        }
        waiting_.clear();
        return !error_;
    }
    int error() const { return error_; }
    void forgive() { error_ = 0; }

protected:
    int_type overflow(int_type letter) override {
        if (traits_type::eq_int_type(letter, traits_type::eof())) return traits_type::not_eof(letter);
        const char one = traits_type::to_char_type(letter);
        return xsputn(&one, 1) == 1 ? letter : traits_type::eof();
    }
    std::streamsize xsputn(const char* text, std::streamsize size) override {
        waiting_.append(text, static_cast<std::size_t>(size));
        return waiting_.size() < most_waiting || write_all() ? size : 0;
    }
    int sync() override { return write_all() ? 0 : -1; }

private:
    static constexpr std::size_t most_waiting = 1 << 16;
    static void wait_for_room() {
        pollfd output{STDOUT_FILENO, POLLOUT, 0};
        ::poll(&output, 1, 1000);
    }

    std::streambuf* replaced_;
    std::string waiting_;
    int error_ = 0;  // the first
};

StandardOutput::StandardOutput() : bytes_(std::make_unique<Bytes>()) {}
StandardOutput::~StandardOutput() = default;

std::string StandardOutput::trouble() {
    if (bytes_->write_all() || bytes_->error() == EPIPE) return "";
    return std::generic_category().message(bytes_->error());
}

void StandardOutput::forgive() {
    bytes_->forgive();
    std::cout.clear();
}

int StandardOutput::end(int code, const std::string& program) {
    const auto why = trouble();
    if (why.empty()) return code;
    std::cerr << program << ": standard output can't be written: " << why << '\n';
    return code == exit_code::done ? exit_code::failed : code;
}

}  // namespace lightnet
