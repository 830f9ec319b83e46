// The launcher's end of the named locks of a run: hears what places want, and passes locks on to them.
#pragma once

#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/run/master/lock_server.hpp"
#include "core/run/message/step.hpp"

namespace lightnet {

/// Keeps one step `attend` at every place, which is answered as soon as the place has something to say, and tells
/// places of the locks that the desk grants them. Belongs to the launcher's thread.
class LockClient {
public:
    /// Sends a step. False: it can't be sent now.
    using Send = std::function<bool(const PlaceAt&, const Step&)>;
    explicit LockClient(Send send) : send_(std::move(send)) {}

    /// Sends what there is to send to these places. Call it now and then.
    void attend(const std::vector<PlaceAt>& places);
    /// A place has answered `attend`.
    void hear(const PlaceAt& place, const Bytes& words);
    /// The place is gone: what it held is free.
    void lose(const PlaceAt& place);

private:
    Send send_;
    LockServer desk_;
    std::set<PlaceAt> attended_;                    // have a step `attend` now
    std::set<PlaceAt> heard_of_;                    // had one
    std::vector<std::pair<PlaceAt, Hash>> grants_;  // to be passed on
};

}  // namespace lightnet
