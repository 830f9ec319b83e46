#include "tools/support/plugins.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <ostream>

#include "core/base/error.hpp"
#include "core/base/hash.hpp"
#include "core/base/joined.hpp"
#include "core/base/plain_file.hpp"
#include "core/base/words_of.hpp"
#include "core/network/light/plugin.hpp"
#include "core/readers/read_scene.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t known_layout = 2;

std::string bytes_in(const std::string& file) try {
    return PlainFile(file, std::uint64_t{1} << 30).text();
} catch (const Error& error) {
    throw Error(std::string("can't be read: ") + error.what());
}

// What keeps objects from going to and fro.
std::vector<std::string> differences(const PluginBuild& theirs) {
    const PluginBuild ours;
    std::vector<std::string> found;
    if (std::string_view(theirs.interface_hash) != ours.interface_hash)
        found.push_back(std::string("it was built against the headers ") + theirs.interface_hash +
                        ", this program has " + ours.interface_hash);
    if (theirs.compiler_abi != ours.compiler_abi)
        found.push_back("the compiler's ABI is " + std::to_string(theirs.compiler_abi) + ", here " +
                        std::to_string(ours.compiler_abi));
    if (theirs.string_abi != ours.string_abi) found.push_back("the standard library has other strings");
    if (theirs.fast_math) found.push_back("it was compiled with -ffast-math, so its bits are anybody's guess");
    return found;
}

const PluginCard& card_in(const std::string& file) {
    void* const library = ::dlopen(fs::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw Error(std::string("can't be loaded: ") + ::dlerror());
    using Entry = const PluginCard* (*)();
    const auto entry = reinterpret_cast<Entry>(::dlsym(library, "lightnet_plugin"));
    if (!entry) throw Error("is no plugin: it has no function lightnet_plugin()");
    const PluginCard* const card = entry();
    if (!card || card->layout != known_layout) throw Error("is a plugin for another lightnet");
    if (const auto found = differences(card->build); !found.empty())
        throw Error("can't be used: " + joined(found, "; ") + ". Build it anew against this lightnet");
    return *card;
}

bool is_word(std::string_view name) {
    return !name.empty() && std::all_of(name.begin(), name.end(),
                                        [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

void add_formats(const std::string& plugin, void (&add)(std::vector<SceneFormat>&)) {
    std::vector<SceneFormat> formats;
    add(formats);
    for (auto& format : formats) format.plugin = plugin;
    add_scene_formats(formats);
}

void load_plugin(const std::string& file, Registry& registry) {
    const std::string hash = to_hex(content_hash(bytes_in(file))).substr(0, 12);
    const PluginCard& card = card_in(file);
    if (!is_word(card.name) || !(card.add_kinds || card.add_formats))
        throw Error("says neither its name, one word, nor what it brings");
    const std::string plugin = std::string(card.name) + " " + card.version + " (" + hash + ")";
    if (registry.plugins().contains(plugin)) return;  // by another name of the same file
    std::vector<Kind> kinds;
    if (card.add_kinds) card.add_kinds(kinds);
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const auto& name = kinds[i].name;
        const Kind* const known = registry.find(name);
        const bool twice = std::any_of(kinds.begin(), kinds.begin() + static_cast<std::ptrdiff_t>(i),
                                       [&](const Kind& kind) { return kind.name == name; });
        if (known || twice)
            throw Error("brings the kind '" + name + "', which " +
                        (twice                   ? "it brings twice"
                         : known->plugin.empty() ? "lightnet has already"
                                                 : "the plugin " + known->plugin + " has brought already"));
    }
    if (card.add_formats) add_formats(plugin, *card.add_formats);
    registry.add_plugin(plugin, std::move(kinds));
}

}  // namespace

void load_plugins(const std::vector<std::string>& files, Registry& registry) {
    std::vector<Problem> problems;
    for (const auto& file : files) try {
            load_plugin(file, registry);
        } catch (const std::exception& error) {
            problems.push_back({{file, 0}, std::string("the plugin ") + words_of(error)});
        }
    if (!problems.empty()) throw UserError(std::move(problems));
}

void pass_on_plugins(const std::vector<std::string>& files) {
    std::string list;
    for (const auto& file : files) list += (list.empty() ? "" : ":") + fs::absolute(file).string();
    if (!list.empty()) ::setenv("LIGHTNETD_PLUGIN", list.c_str(), 1);
}

std::string plugin_folder() {
    if (const char* folder = std::getenv("LIGHTNET_PLUGIN_FOLDER")) return folder;
    if (const char* data = std::getenv("XDG_DATA_HOME"); data && *data) return fs::path(data) / "lightnet/plugins";
    const char* const home = std::getenv("HOME");
    return home && *home ? fs::path(home) / ".local/share/lightnet/plugins" : fs::path();
}

void load_installed_plugins(Registry& registry, std::ostream& err) {
    std::vector<std::string> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(plugin_folder(), none))
        if (entry.path().extension() == ".so") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const auto& file : files) try {
            load_plugins({file}, registry);
        } catch (const UserError& error) {
            err << "lightnet: left out: " << error.what() << '\n';
        }
}

}  // namespace lightnet
