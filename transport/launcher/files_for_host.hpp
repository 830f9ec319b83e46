// Files on their way to a host.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>

#include "core/base/hash.hpp"
#include "core/readers/files/files.hpp"
#include "transport/lines/message_frame.hpp"
#include "transport/wire/line_pace.hpp"

namespace lightnet {

/// Files of the job, and what others have prepared: in pieces, as many under way as the line takes. One thread's.
class FilesForHost {
public:
    using Time = LinePace::Time;
    /// False: the line takes nothing now.
    using Send = std::function<bool(Frames&)>;

    /// `offered` outlives it.
    explicit FilesForHost(const std::map<Hash, Bytes>& offered);

    /// The host lacks these of the offered ones: hexadecimal digits of their hashes, one behind the other.
    void lacks_offered(const std::string& hashes);
    /// Is this new? Then the host is to be told what to expect; else see is_there().
    bool bring(const Hash& name, const Bytes& bytes);
    /// It could not be told.
    void forget(const Hash& name) { brought_.erase(name); }
    /// Of what was brought: the host lacks it.
    void lacks(const Hash& name);
    /// Of what was brought: the host has it.
    void has(const Hash& name);
    bool is_there(const Hash& name) const { return brought_.at(name).here; }

    /// Something is still to be sent.
    bool waiting() const { return !pieces_.empty(); }
    bool under_way() const { return pace_.under_way() > 0; }
    /// What is under way has not been taken for long.
    bool stuck(Time now) const;
    /// How long what is under way may still take.
    std::chrono::milliseconds expected() const { return pace_.expected(); }
    /// Sends of what waits as much as may be under way, as files of `run`. How many bytes of files.
    std::uint64_t send(std::uint64_t run, Time now, const Send& send);
    /// The host has taken a piece.
    void piece_taken(Time now);
    /// The host needs nothing any more. What is under way stays so.
    void clear();
    /// Another connection: nothing is under way, and nothing wanted yet.
    void restart();

private:
    struct Piece {
        Hash hash;
        std::uint64_t offset;  // of what is still to be sent
    };
    struct Brought {
        Bytes bytes;
        bool here = false;
    };
    Bytes bytes_of(const Hash& hash) const;
    void queue(const Hash& hash);

    const std::map<Hash, Bytes>& offered_;
    std::map<Hash, Brought> brought_;
    std::deque<Piece> pieces_;
    LinePace pace_;
    Time taken_{};  // the last piece, or when the first one was sent
};

}  // namespace lightnet
