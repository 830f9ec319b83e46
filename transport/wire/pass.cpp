#include "transport/wire/pass.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/base/hash.hpp"

namespace lightnet {
namespace {

constexpr std::size_t secret_digits = 64, least_digits = 32, most_digits = 4096;

std::string digits_of(const unsigned char* bytes, std::size_t count) {
    constexpr char digits[] = "0123456789abcdef";
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
        text += digits[bytes[i] >> 4];
        text += digits[bytes[i] & 15];
    }
    return text;
}

std::string random_digits(std::size_t count) {
    std::array<unsigned char, secret_digits / 2> bytes{};
    if (getrandom(bytes.data(), count / 2, 0) != static_cast<ssize_t>(count / 2))
        throw Error(std::string("no random numbers are to be had: ") + std::strerror(errno));
    return digits_of(bytes.data(), count / 2);
}

struct Descriptor {
    int number;
    ~Descriptor() {
        if (number >= 0) close(number);
    }
};

// Whoever is first makes it; it appears under its name when it is whole.
void make(const std::string& file) {
    const auto folder = std::filesystem::path(file).parent_path();
    if (!folder.empty()) std::filesystem::create_directories(folder);
    try {
        write_new_secret(file, random_digits(secret_digits) + "\n");
    } catch (const Error& error) {
        throw Error(std::string("no pass can be made: ") + error.what());
    }
}

}  // namespace

Pass Pass::of(const std::string& file) {
    Descriptor in{open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (in.number < 0 && errno == ENOENT) {
        make(file);
        in.number = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    }
    struct stat state {};
    if (in.number < 0 || fstat(in.number, &state) != 0)
        throw Error(file, std::string("the pass can't be read: ") + std::strerror(errno));
    if (!S_ISREG(state.st_mode) || state.st_uid != geteuid() || (state.st_mode & 077) != 0)
        throw Error(file, "others can read or change this pass; it must be a file of yours with mode 0600");
    std::string secret(most_digits, '\0');
    const auto size = read(in.number, secret.data(), secret.size());
    secret.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    secret.resize(secret.find_last_not_of(" \r\n\t") + 1);
    if (secret.size() < least_digits)
        throw Error(file, "a pass has at least " + std::to_string(least_digits) + " characters");
    return Pass(std::move(secret));
}

std::string Pass::usual_file() {
    if (const char* named = std::getenv("LIGHTNET_PASS"); named && *named) return named;
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config && *config == '/')
        return std::string(config) + "/lightnet/pass";
    if (const char* home = std::getenv("HOME"); home && *home == '/')
        return std::string(home) + "/.config/lightnet/pass";
    throw Error("there is no home folder for the pass that joining takes; say --pass FILE");
}

std::string Pass::proof(std::string_view challenge, const Claim& claim) const {
    // With the length of each part before it: no two claims are the same text.
    std::string text;
    for (const auto& part : {std::string(challenge), claim.name, std::to_string(claim.process), claim.endpoint})
        text += std::to_string(part.size()) + ":" + part;
    return to_hex(keyed_hash(secret_, text));
}

// Takes as long wherever the two differ.
bool Pass::proves(std::string_view challenge, const Claim& claim, std::string_view said) const {
    const auto right = proof(challenge, claim);
    if (said.size() != right.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < right.size(); ++i) difference |= static_cast<unsigned char>(said[i] ^ right[i]);
    return difference == 0;
}

std::string random_challenge() { return random_digits(32); }

}  // namespace lightnet
