#include "lua/sandbox.hpp"

#include <unistd.h>
#include <lua_any.hpp>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "core/base/printable.hpp"
#include "core/network/graph/value.hpp"
#include "lua/files.hpp"
#include "lua/function_source.hpp"

namespace lightnet::lua {
namespace {

constexpr std::size_t most_printed = 64 << 10;

constexpr const char* asked_field = "asked";  // of the registry: some file was required, or should have been

// The order of a Lua table depends on where memory lies, so a graph made in a loop over one would differ from run to
// run: numbers first, then texts, then the rest in whatever order.
constexpr const char* prelude = R"lua(
local next, sort, type, setmetatable = next, table.sort, type, setmetatable
local rank = { number = 1, string = 2 }
local function before(a, b)
    local ra, rb = rank[type(a)] or 3, rank[type(b)] or 3
    if ra ~= rb then return ra < rb end
    return ra < 3 and a < b
end
function pairs(t)
    local keys, n = {}, 0
    for key in next, t do n = n + 1; keys[n] = key end
    sort(keys, before)
    local i = 0
    return function()
        while i < n do
            i = i + 1
            local value = t[keys[i]]
            if value ~= nil then return keys[i], value end
        end
    end
end
math.randomseed(1)
math.randomseed = nil
string.dump = nil
for _, name in next, { "load", "loadfile", "dofile", "collectgarbage", "warn", "_G" } do
    _ENV[name] = nil
end
)lua";

// Lua shortens long names in its messages, like this.
std::string short_name(const std::string& file) {
    constexpr std::size_t most = LUA_IDSIZE - 1;
    return file.size() <= most ? file : "..." + file.substr(file.size() - (most - 3));
}

std::string folder_of(const std::string& file) {
    const auto folder = std::filesystem::path(file).parent_path();
    return folder.empty() ? "." : folder.string();
}

/// Marks a required file as running, and forgets it again when it ends by an error.
class Running {
public:
    Running(std::map<std::string, bool>& done, std::string path) : done_(done), path_(std::move(path)) {
        done_[path_] = false;
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() {
        if (!done_[path_]) done_.erase(path_);
    }

private:
    std::map<std::string, bool>& done_;
    const std::string path_;
};

SourceLine source_line(lua_Debug& info) {
    return {info.source[0] == '@' ? info.source + 1 : "", std::max(info.currentline, 0)};
}

}  // namespace

void Sandbox::Close::operator()(lua_State* L) const { lua_close(L); }

Sandbox::Sandbox(std::string file, std::size_t memory) : file_(std::move(file)), memory_(memory) {
    state_.reset(lua_newstate(&Sandbox::allocate, this));
    if (!state_) throw Error(file_, "no memory for a Lua state");
    *static_cast<Sandbox**>(lua_getextraspace(state_.get())) = this;
    const auto open = [](lua_State* L) {
        of(L).open_libraries();
        return 0;
    };
    lua_pushcfunction(state_.get(), open);
    if (const int status = lua_pcall(state_.get(), 0, 0, 0); status != LUA_OK) throw error_at_top(status);
}

Sandbox::~Sandbox() = default;

Sandbox& Sandbox::of(lua_State* L) { return **static_cast<Sandbox**>(lua_getextraspace(L)); }

void* Sandbox::allocate(void* self, void* block, std::size_t old_size, std::size_t new_size) {
    auto& box = *static_cast<Sandbox*>(self);
    if (!block) old_size = 0;  // else it tells what is made, not how large it was
    if (new_size == 0) {
        std::free(block);
        box.used_ -= old_size;
        return nullptr;
    }
    if (new_size > old_size && new_size - old_size > box.memory_ - box.used_) return nullptr;
    void* const moved = std::realloc(block, new_size);
    if (moved) box.used_ += new_size - old_size;
    return moved;
}

void Sandbox::open_libraries() {
    lua_State* const L = state();
    const luaL_Reg libraries[] = {{LUA_GNAME, luaopen_base},
                                  {LUA_STRLIBNAME, luaopen_string},
                                  {LUA_TABLIBNAME, luaopen_table},
                                  {LUA_MATHLIBNAME, luaopen_math},
                                  {LUA_UTF8LIBNAME, luaopen_utf8}};
    for (const auto& [name, open] : libraries) {
        luaL_requiref(L, name, open, 1);
        lua_pop(L, 1);
    }
    lua_register(L, "print", &Sandbox::print);
    lua_register(L, "require", &Sandbox::require);
    if (luaL_loadstring(L, prelude) != LUA_OK) lua_error(L);
    lua_call(L, 0, 0);
}

void Sandbox::run(const std::string& text) {
    lua_State* const L = state();
    lua_pushcfunction(L, &Sandbox::keep_position);
    try {
        load(L, text, file_);
    } catch (const Error&) {
        throw error_at_top(LUA_ERRSYNTAX);
    }
    if (const int status = lua_pcall(L, 0, 0, -2); status != LUA_OK) throw error_at_top(status);
    lua_pop(L, 1);
}

// Leaves the function on the stack, or the message, and throws.
void Sandbox::load(lua_State* L, const std::string& text, const std::string& file) {
    chunks_.push_back(file);
    texts_[file] = text;
    if (text.starts_with(LUA_SIGNATURE)) {
        lua_pushliteral(L, "compiled Lua is not read, only text");
        throw Error(file);
    }
    if (luaL_loadbufferx(L, text.data(), text.size(), ("@" + file).c_str(), "t") != LUA_OK) throw Error(file);
}

SourceLine Sandbox::caller() const {
    lua_State* const L = state();
    lua_Debug info{};
    for (int level = 1; lua_getstack(L, level, &info); ++level) {
        lua_getinfo(L, "Sl", &info);
        if (info.currentline > 0 && info.source[0] == '@') return source_line(info);
    }
    return {file_, 0};
}

std::string Sandbox::source_of_function(lua_State* L, int index) const {
    const int top = lua_gettop(L);
    index = lua_absindex(L, index);
    lua_Debug info{};
    lua_pushvalue(L, index);
    lua_getinfo(L, ">S", &info);
    const auto text = texts_.find(info.source[0] == '@' ? info.source + 1 : "");
    if (text == texts_.end()) throw UserError({}, "is a function that stands in no file");
    lua_getfield(L, LUA_REGISTRYINDEX, "lightnet.globals");
    if (!lua_istable(L, -1)) lua_newtable(L);
    lua_pushvalue(L, index);
    try {
        std::string source = function_source(L, top + 1, text->first, text->second);
        lua_settop(L, top);
        return source;
    } catch (const Error& error) {
        lua_settop(L, top);
        throw UserError({}, error.what());
    }
}

// The message handler: it runs where the error was thrown, so the stack still tells the line.
int Sandbox::keep_position(lua_State* L) {
    of(L).last_error_ = of(L).caller();
    return 1;
}

UserError Sandbox::error_at_top(int status) {
    lua_State* const L = state();
    if (status == LUA_ERRMEM)
        return {{file_, 0}, "needs more than " + number_text(static_cast<double>(memory_ >> 20)) + " MiB of memory"};
    const char* text = lua_tostring(L, -1);
    std::string message = text ? text : std::string("an error of type ") + luaL_typename(L, -1);
    SourceLine where = last_error_.file.empty() ? SourceLine{file_, 0} : last_error_;
    strip_position(message, where);
    return {where, message};
}

// Takes "file:7: " off the message, and tells it as a place.
bool Sandbox::strip_position(std::string& message, SourceLine& where) const {
    for (const auto& file : chunks_) {
        const std::string start = short_name(file) + ":";
        if (!message.starts_with(start)) continue;
        std::size_t end = start.size();
        while (end < message.size() && std::isdigit(static_cast<unsigned char>(message[end]))) ++end;
        if (end == start.size() || end - start.size() > 9 || message.compare(end, 2, ": ") != 0) continue;
        where = {file, std::stoi(message.substr(start.size(), end - start.size()))};
        message.erase(0, end + 2);
        return true;
    }
    return false;
}

int Sandbox::print(lua_State* L) {
    Sandbox& box = of(L);
    std::string line;
    for (int i = 1; i <= lua_gettop(L); ++i) {
        std::size_t size = 0;
        const char* text = luaL_tolstring(L, i, &size);
        line += i > 1 ? "\t" : "";
        line.append(text, std::min(size, most_printed));
        lua_pop(L, 1);
    }
    line = printable(line, true) + "\n";
    const std::size_t room = most_printed - box.printed_;
    line.resize(std::min(line.size(), room));
    box.printed_ += line.size();
    // what doesn't get through is lost, and no harm done
    if (::write(STDERR_FILENO, line.data(), line.size()) < 0) box.printed_ = most_printed;
    return 0;
}

int Sandbox::require(lua_State* L) {
    const char* name = luaL_checkstring(L, 1);
    try {
        return of(L).require(L, name);
    } catch (const std::bad_alloc&) {
        return luaL_error(L, "not enough memory");
    } catch (const std::exception& error) {
        lua_pushfstring(L, "require \"%s\": %s", name, error.what());
    }
    luaL_where(L, 1);
    lua_insert(L, -2);
    lua_concat(L, 2);
    return lua_error(L);
}

// What a file returns is kept in the registry, under its name.
int Sandbox::require(lua_State* L, const std::string& name) {
    lua_pushboolean(L, 1);
    lua_setfield(L, LUA_REGISTRYINDEX, asked_field);
    std::string relative = name;
    std::replace(relative.begin(), relative.end(), '.', '/');
    const std::string folder = folder_of(file_);
    const std::string path = (std::filesystem::path(folder) / (relative + ".lua")).lexically_normal().string();
    const std::string key = "require:" + path;
    if (const auto known = done_.find(path); known != done_.end()) {
        if (!known->second) throw Error("it requires itself");
        lua_getfield(L, LUA_REGISTRYINDEX, key.c_str());
        return 1;
    }
    const std::string text = read_text_inside(folder, path);
    const Running running(done_, path);
    try {
        load(L, text, path);
    } catch (const Error&) {
        lua_error(L);  // as it stands: it names the line of the required file
    }
    lua_call(L, 0, 1);
    if (lua_isnil(L, -1)) {
        lua_pop(L, 1);
        lua_pushboolean(L, 1);
    }
    lua_pushvalue(L, -1);
    lua_setfield(L, LUA_REGISTRYINDEX, key.c_str());
    done_[path] = true;
    return 1;
}

bool is_alone(const Sandbox& sandbox) {
    const bool asked = lua_getfield(sandbox.state(), LUA_REGISTRYINDEX, asked_field) != LUA_TNIL;
    lua_pop(sandbox.state(), 1);
    return !asked;
}

}  // namespace lightnet::lua
