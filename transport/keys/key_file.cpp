#include "transport/keys/key_file.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_bytes = 4096;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // they look into their process by another one
constexpr bool may_be_looked_into = true;
#else
constexpr bool may_be_looked_into = false;
#endif

struct KeyDescriptor {
    int number;
    ~KeyDescriptor() {
        if (number >= 0) close(number);
    }
};

std::string why() { return std::strerror(errno); }

// A system's own service manager hands keys over in files of root's, which it opens to their reader alone.
bool is_private(const struct stat& state) {
    if (!S_ISREG(state.st_mode)) return false;
    if (state.st_uid == geteuid()) return (state.st_mode & 077) == 0;
    return state.st_uid == 0 && (state.st_mode & 027) == 0;
}

KeyPair read_key(const std::string& file, int descriptor) {
    keep_secrets_out_of_dumps();
    struct stat state {};
    if (descriptor < 0 || fstat(descriptor, &state) != 0) throw Error(file, "the key can't be read: " + why());
    if (!is_private(state))
        throw Error(file,
                    "others can read or change this key; it must be a file of yours with mode 0600, or one "
                    "of root's that only your group may read (0440, as a Secret with fsGroup)");
    std::string text(most_bytes, '\0');
    const auto size = read(descriptor, text.data(), text.size());
    text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    text.resize(text.find_last_not_of(" \r\n\t") + 1);
    const auto pair = KeyPair::from_secret(text);
    if (!pair) throw Error(file, "there is no key in it; lightnet key --key ANOTHER.FILE makes one");
    return *pair;
}

int open_to_read(const std::string& file) { return open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); }

// It appears under its name when it is whole. False: there is one.
bool make(const std::string& file, const KeyPair& pair) {
    const auto folder = std::filesystem::path(file).parent_path();
    if (!folder.empty()) std::filesystem::create_directories(folder);
    try {
        return write_new_secret(file, pair.secret_text() + "\n");
    } catch (const Error& error) {
        throw Error(std::string("no key can be made: ") + error.what());
    }
}

}  // namespace

// DECISIONS: secrets-in-no-dump
void keep_secrets_out_of_dumps() {
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
    if (!may_be_looked_into) ::prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);
}

std::string usual_key_file() {
    if (const char* named = std::getenv("LIGHTNET_KEY"); named && *named) return named;
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config && *config == '/')
        return std::string(config) + "/lightnet/key";
    if (const char* home = std::getenv("HOME"); home && *home == '/')
        return std::string(home) + "/.config/lightnet/key";
    throw Error("there is no home folder for a key; say --key FILE");
}

std::optional<KeyPair> take_key_from_environment() {
    const char* text = std::getenv(secret_key_variable);
    if (!text) return std::nullopt;
    keep_secrets_out_of_dumps();
    const auto pair = KeyPair::from_secret(text);
    unsetenv(secret_key_variable);
    if (!pair) throw Error(secret_key_variable, "holds no key");
    return pair;
}

KeyPair load_key(const std::string& file) {
    const KeyDescriptor in{open_to_read(file)};
    if (in.number < 0 && errno == ENOENT)
        throw Error(file, "there is no key yet; lightnet key --key " + file + " makes one");
    return read_key(file, in.number);
}

KeyPair load_or_make_key(const std::string& file) {
    if (!key_is_there(file)) make(file, KeyPair::random());
    return load_key(file);
}

bool key_is_there(const std::string& file) {
    struct stat state {};
    return lstat(file.c_str(), &state) == 0;
}

SecretFile::SecretFile(const std::string& name, const KeyPair& pair)
    : path_((std::filesystem::path(usual_key_file()).parent_path() / name).string()) {
    if (!make(path_, pair)) throw Error(path_, "is there already");
}

SecretFile::~SecretFile() { unlink(path_.c_str()); }

}  // namespace lightnet
