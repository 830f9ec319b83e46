#include "tools/hosts/host_json.hpp"

#include "core/base/json_tree.hpp"
#include "core/base/printable.hpp"
#include "tools/hosts/host_table.hpp"

namespace lightnet {

std::string host_json(const std::vector<HostAnswer>& hosts, const std::vector<std::string>& joining,
                      const std::string& build) {
    JsonTree all = JsonTree::list();
    for (const auto& host : hosts) {
        const auto& machine = host.machine;
        all.push_back({{"asked", in_utf8(host.asked)},
                       {"of_launcher", host.of_launcher},
                       {"name", in_utf8(host.name)},
                       {"there", is_there(host)},
                       {"state", in_utf8(host.state)},
                       {"same_build", !is_other_build(host, build)},
                       {"who", in_utf8(host.who)},
                       {"nodes", in_utf8(host.nodes)},
                       {"places", host.places},
                       {"progress", host.progress},
                       {"bundles", host.bundles},
                       {"broken_packets", host.broken_packets},
                       {"resident_memory", host.resident_memory},
                       {"machine",
                        {{"name", in_utf8(machine.name)},
                         {"cpu", in_utf8(machine.cpu)},
                         {"isa", in_utf8(machine.isa)},
                         {"build", in_utf8(machine.version)},
                         {"cores", machine.cores},
                         {"memory", machine.memory}}}});
    }
    const JsonTree json{{"format", "lightnet hosts 1"}, {"build", build}, {"hosts", all}, {"joining", joining}};
    return to_text(json, {.indent = 2}) + "\n";
}

}  // namespace lightnet
