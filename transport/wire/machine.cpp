#include "transport/wire/machine.hpp"

#include <fstream>
#include <random>

#include "core/base/allowance.hpp"
#include "core/base/build_info.hpp"
#include "core/base/this_machine.hpp"
#include "core/run/assembly/fingerprint.hpp"

namespace lightnet {
namespace {

std::string model_of_cpu() {
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("model name"))
            if (const auto colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
    return "unknown";
}

}  // namespace

Machine this_machine() {
    Machine machine;
    machine.name = machine_name();
    machine.cpu = model_of_cpu();
    machine.isa = usual_isa();
    machine.version = build_id();
    machine.cores = usable_cores();
    machine.memory = usable_memory();
    return machine;
}

std::uint64_t process_number() {
    std::random_device device;
    return ((std::uint64_t{device()} << 32) | device()) | 1;
}

void set(packet::Fields& fields, const Machine& machine) {
    fields.set("machine", machine.name).set("cpu", machine.cpu).set("isa", machine.isa).set("build", machine.version);
    fields.set("cores", machine.cores).set("memory", machine.memory);
}

Machine machine_from(const packet::Fields& fields) {
    return {fields.text("machine"), fields.text("cpu"),     fields.text("isa"),
            fields.text("build"),   fields.number("cores"), fields.number("memory")};
}

}  // namespace lightnet
