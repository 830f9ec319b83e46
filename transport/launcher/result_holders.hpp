// The hosts that have results of preparing, as far as the launcher knows.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/base/hash.hpp"

namespace lightnet {

/// Hosts are told of others that have what they lack, so that not all of it passes the launcher's line. One thread's.
/// DECISIONS: from-the-nearest
class ResultHolders {
public:
    void has(const std::string& host, const Hash& result);
    /// It is gone, or gives no more.
    void lose(const std::string& host);
    /// Some that have it and that `asker` can call, others each time; those on its machine first.
    std::vector<std::string> of(const Hash& result, const std::string& asker);

private:
    std::map<Hash, std::vector<std::string>> hosts_;
    std::size_t turn_ = 0;
};

}  // namespace lightnet
