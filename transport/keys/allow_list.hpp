// The list of keys that are let in.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "transport/keys/key.hpp"

namespace lightnet {

/// Public keys and what their owners are called: one key a line, and its name behind it; "#" begins a comment. A name
/// that ends in '*' stands for all that begin so: their owner says which. A value.
class AllowList {
public:
    AllowList() = default;
    /// Throws UserError that names every bad line. `file`: what they are called there.
    static AllowList parse(std::string_view text, const std::string& file);
    /// As parse(), what is no such line is left out.
    static AllowList parse_what_can_be(std::string_view text);
    void add(const PublicKey& key, const std::string& name) { names_[key] = name; }

    /// None: it isn't on the list.
    std::optional<std::string> name_of(const PublicKey& key) const;
    /// The first of that name. None: there is none.
    std::optional<PublicKey> key_of(const std::string& name) const;
    bool has(const PublicKey& key) const { return names_.contains(key); }
    bool empty() const { return names_.empty(); }
    std::string text() const;
    friend bool operator==(const AllowList&, const AllowList&) = default;

private:
    std::map<PublicKey, std::string> names_;
};

/// How the owner of a key is called: by the name on the list, or, where that leaves it open, by the one that he `said`.
std::string called(const std::string& listed, const std::string& said);

/// A list that its owner may change while it is in use. One thread's.
class AllowFile {
public:
    /// `whom`: the name of a file, which nobody but its owner may change; or one public key. Throws UserError or Error.
    explicit AllowFile(std::string whom);

    const AllowList& list() const { return list_; }
    /// Of the file; "the command line" where there is none.
    std::string name() const;
    /// Reads the file again when it has changed, and has stayed so for a moment: editors write in pieces. True: the
    /// list is another one. What can't be read, or what others can change, lets nobody in, and `say` is told why.
    bool refresh(std::chrono::steady_clock::time_point now, const std::function<void(const std::string&)>& say);

private:
    struct Stamp {  // all zero: it is not there
        long long seconds = 0, nanoseconds = 0, size = 0;
        long long changed_seconds = 0, changed_nanoseconds = 0;  // of whose it is, and who may write, as well
        unsigned long long inode = 0;
        bool safe = true;  // nobody but its owner can change it
        friend bool operator==(const Stamp&, const Stamp&) = default;
    };
    Stamp stamp() const;
    AllowList read() const;

    std::string file_;  // "": there is none
    AllowList list_;
    Stamp taken_, seen_;
    std::chrono::steady_clock::time_point looked_{};
};

/// Whose hosts may join a run.
struct JoinKeys {
    std::optional<AllowFile> file;  // may change while the run lasts
    AllowList more;                 // that the run was told of otherwise
};

}  // namespace lightnet
