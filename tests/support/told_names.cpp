// Preloaded, it looks names up in a file that a test writes, instead of asking anybody: a name and its addresses in
// each line, or "silent", which takes as long as a name server that never answers. Nobody else has a name.
#include <arpa/inet.h>
#include <dlfcn.h>
#include <netdb.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

namespace {

using Lookup = int (*)(const char*, const char*, const addrinfo*, addrinfo**);

Lookup real() { return reinterpret_cast<Lookup>(dlsym(RTLD_NEXT, "getaddrinfo")); }

// What stands behind the name; none: it isn't there.
std::optional<std::string> told_of(const std::string& name) {
    std::ifstream in(std::getenv("LIGHTNET_TOLD_NAMES"));
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(name + " ")) return line.substr(name.size() + 1);
    return std::nullopt;
}

bool is_number(const char* name) {
    in6_addr room{};
    return inet_pton(AF_INET, name, &room) == 1 || std::strchr(name, ':') != nullptr;
}

}  // namespace

extern "C" int getaddrinfo(const char* name, const char* service, const addrinfo* wanted, addrinfo** found) {
    if (!name || is_number(name) || !std::getenv("LIGHTNET_TOLD_NAMES")) return real()(name, service, wanted, found);
    const auto told = told_of(name);
    if (!told) return EAI_NONAME;
    if (*told == "silent") {
        constexpr unsigned patience = 60;
        sleep(patience);
        return EAI_AGAIN;
    }
    std::istringstream in(*told);
    addrinfo** end = found;
    for (std::string number; in >> number; end = &(*end)->ai_next)
        if (const int fault = real()(number.c_str(), service, wanted, end)) return fault;
    return 0;
}
