#include "transport/launcher/result_holders.hpp"

#include <algorithm>

#include "core/base/ip_address.hpp"
#include "transport/wire/relay_address.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_told = 4;

std::string machine_in(const std::string& host) {
    const auto parts = tcp_endpoint(host);
    return parts ? parts->host : host;
}

}  // namespace

void ResultHolders::has(const std::string& host, const Hash& result) {
    auto& hosts = hosts_[result];
    if (std::ranges::find(hosts, host) == hosts.end()) hosts.push_back(host);
}

void ResultHolders::lose(const std::string& host) {
    for (auto& [result, hosts] : hosts_) std::erase(hosts, host);
    std::erase_if(hosts_, [](const auto& one) { return one.second.empty(); });
}

std::vector<std::string> ResultHolders::of(const Hash& result, const std::string& asker) {
    const auto found = hosts_.find(result);
    if (found == hosts_.end()) return {};
    auto hosts = found->second;
    std::erase_if(hosts, [&](const auto& host) { return host == asker || !calls_directly(asker, host); });
    if (hosts.empty()) return hosts;
    std::ranges::rotate(hosts, hosts.begin() + std::ptrdiff_t(turn_++ % hosts.size()));
    std::ranges::stable_partition(hosts, [&](const auto& host) { return machine_in(host) == machine_in(asker); });
    hosts.resize(std::min(hosts.size(), most_told));
    return hosts;
}

}  // namespace lightnet
