#include "core/base/log_bounds.hpp"

#include <algorithm>

namespace lightnet {

bool LogBounds::may_be_said(const std::string& kind, Time now) {
    const auto known = buckets_.contains(kind) || buckets_.size() < most_kinds;
    auto& bucket = buckets_.try_emplace(known ? kind : std::string(), Bucket{per_minute_, now}).first->second;
    const std::chrono::duration<double> passed = now - bucket.filled;
    bucket.tokens = std::min(per_minute_, bucket.tokens + passed.count() / 60 * per_minute_);
    bucket.filled = now;
    if (bucket.tokens < 1) {
        if (bucket.left_out++ == 0) bucket.since = now;
        return false;
    }
    bucket.tokens -= 1;
    return true;
}

std::vector<std::pair<std::string, std::uint64_t>> LogBounds::left_out(Time now) {
    std::vector<std::pair<std::string, std::uint64_t>> told;
    for (auto& [kind, bucket] : buckets_) {
        if (bucket.left_out == 0 || now - bucket.since < std::chrono::minutes(1)) continue;
        told.emplace_back(kind, bucket.left_out);
        bucket.left_out = 0;
    }
    return told;
}

std::string kind_of_line(const std::string& text) {
    const auto first = text.find(' ');
    return text.substr(0, first == text.npos ? first : text.find(' ', first + 1));
}

}  // namespace lightnet
