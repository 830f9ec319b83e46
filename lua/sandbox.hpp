// A Lua state that can compute, but reach nothing.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.hpp"

struct lua_State;

namespace lightnet::lua {

/// One Lua state with base (less load, loadfile, dofile, collectgarbage), string, table, math and utf8. Its memory is
/// capped, its random numbers and the order of pairs() are the same each time, print() goes to standard error, and
/// require() reaches files in the folder of the main file and below only. Meant for a process that is killed when it
/// runs too long, as nothing here stops a loop.
class Sandbox {
public:
    /// `file`: the main file, as the user names it.
    Sandbox(std::string file, std::size_t memory);
    Sandbox(const Sandbox&) = delete;
    Sandbox& operator=(const Sandbox&) = delete;
    ~Sandbox();

    lua_State* state() const { return state_.get(); }
    const std::string& file() const { return file_; }

    /// Runs `text` as the main file. Its globals are those of the table that LUA_RIDX_GLOBALS names at that time.
    /// Throws UserError with the line at fault.
    void run(const std::string& text);

    /// Where the function that called the running C function stands.
    SourceLine caller() const;

    /// Of a Lua function on the stack, with the constants of the file that it names: see function_source(). Throws
    /// UserError, whose place says nothing.
    std::string source_of_function(lua_State* L, int index) const;

    static Sandbox& of(lua_State* L);

private:
    struct Close {
        void operator()(lua_State* L) const;
    };
    static void* allocate(void* self, void* block, std::size_t old_size, std::size_t new_size);
    static int keep_position(lua_State* L);
    static int print(lua_State* L);
    static int require(lua_State* L);

    void open_libraries();
    int require(lua_State* L, const std::string& name);
    void load(lua_State* L, const std::string& text, const std::string& file);
    UserError error_at_top(int status);
    bool strip_position(std::string& message, SourceLine& where) const;

    std::string file_;
    std::size_t memory_, used_ = 0;
    std::size_t printed_ = 0;
    std::vector<std::string> chunks_;           // files that were loaded
    std::map<std::string, std::string> texts_;  // by their names
    SourceLine last_error_;                     // innermost line when the last error was thrown
    std::map<std::string, bool> done_;          // required files; false: still running
    std::unique_ptr<lua_State, Close> state_;
};

/// Has what runs there asked for no other file?
bool is_alone(const Sandbox& sandbox);

}  // namespace lightnet::lua
