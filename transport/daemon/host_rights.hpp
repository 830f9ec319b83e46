// Rights of those who call at a host's door.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "transport/keys/allow_list.hpp"
#include "transport/wire/rights.hpp"

namespace lightnet {

/// Knows by their keys the launchers that may begin runs, the one that has begun one, and the other hosts of its run.
/// Asked for each message, as a connection outlives the rights of who has made it. One thread's.
class HostRights {
public:
    /// `allow`: see AllowFile; "": no list. `dialled`: the key of the launcher that this host joins. Without either,
    /// nobody is asked for a key. Throws UserError or Error.
    HostRights(const std::string& allow, const std::optional<PublicKey>& dialled);

    bool asks_for_keys() const { return launchers_ || dialled_; }
    /// May he come in?
    bool knows(const PublicKey& key) const;
    /// `key` as text; empty: he has none.
    bool may(std::string_view key, packet::Type type, bool of_the_run);
    bool is_owner(std::string_view key) const { return !asks_for_keys() || key == owner_; }
    /// Of the list of launchers.
    std::string list_name() const { return launchers_ ? launchers_->name() : "the command line"; }

    /// Whose run is served from now on: "": nobody's.
    void serve(std::string_view owner);
    void use_members(AllowList members);
    const AllowList& members() const { return members_; }
    /// Looks whether the list has changed. True: the launcher whose run is served is no more on it.
    bool owner_is_gone(std::chrono::steady_clock::time_point now, const std::function<void(const std::string&)>& say);

private:
    Party party_of(std::string_view key);
    Party find_party(std::string_view key) const;
    bool is_launcher(const PublicKey& key) const;

    std::optional<AllowFile> launchers_;
    std::optional<PublicKey> dialled_;
    std::string owner_;  // key, as text
    AllowList members_;
    std::map<std::string, Party, std::less<>> parties_;  // of those who have been asked about; anew with each change
};

}  // namespace lightnet
