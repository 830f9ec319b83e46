// The file of a key.
#pragma once

#include <optional>
#include <string>

#include "transport/keys/key.hpp"

namespace lightnet {

/// What this process holds from now on is in no core dump, and no other process of its user can look into it: for
/// whoever has a key. The functions here that give one have done so.
void keep_secrets_out_of_dumps();

/// Where it lies when the user says nothing: $LIGHTNET_KEY, else below ~/.config/lightnet. Throws Error when there is
/// no such folder.
std::string usual_key_file();
/// The variable of the environment by which a launcher hands a daemon that it starts its secret key.
inline constexpr const char* secret_key_variable = "LIGHTNET_SECRET_KEY";
/// Takes the pair out of it. None: it is not set. Throws Error when it holds no key.
std::optional<KeyPair> take_key_from_environment();

/// The pair in a file. Throws Error when there is none, or others could read it.
KeyPair load_key(const std::string& file);
/// The pair in a file; where there is none, one is made, readable by its user only. Nothing is ever overwritten.
KeyPair load_or_make_key(const std::string& file);
bool key_is_there(const std::string& file);

/// A file with a secret for programs that this one has others start. Gone with this object.
class SecretFile {
public:
    /// Makes it, with mode 0600, in the folder of usual_key_file(). Throws Error.
    SecretFile(const std::string& name, const KeyPair& pair);
    ~SecretFile();
    SecretFile(const SecretFile&) = delete;
    SecretFile& operator=(const SecretFile&) = delete;
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

}  // namespace lightnet
