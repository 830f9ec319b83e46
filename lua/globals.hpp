// The globals that a file of ours sees: constants, their overrides, and names that nobody has given yet.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/problem_list.hpp"
#include "lua/sandbox.hpp"

namespace lightnet::lua {

/// Stands between a file and its globals. Reading a name that nobody gave yields an Unknown, which may be called (that
/// makes a node) or stand for a node that is named further down; whoever does neither has mistyped something. Belongs
/// to one Sandbox, and must outlive its runs.
class Globals {
public:
    Globals(Sandbox& sandbox, std::map<std::string, std::string> constants);
    Globals(const Globals&) = delete;
    Globals& operator=(const Globals&) = delete;
    virtual ~Globals() = default;

    /// Complete when all is finished; a hundred at most are told.
    std::vector<Problem> take_problems() { return problems_.take(); }

protected:
    /// A name that was read before anybody gave it.
    struct Unknown {
        std::string name;
        SourceLine where;
        bool taken = false;  // somebody knows what it stands for
    };

    /// The Unknown at that place of the stack, or null.
    Unknown* unknown_at(int index);
    /// An Unknown was called, with its arguments from 2 on.
    virtual int call(lua_State* L, Unknown& callee) = 0;
    /// The value on top of the stack is about to become the global `name`.
    virtual void assigned(lua_State* L, const std::string& name) = 0;
    /// Makes a function of `self` a global that files may call.
    void offer(const char* name, int (*function)(lua_State*));
    /// Makes a number a global, or what -D says of that name. Returns which it is.
    double give(const std::string& name, double value);
    /// Complains of all that was read in vain, and of overrides that met nothing. `named`: other names one may have
    /// meant.
    void finish(const std::vector<std::string>& named);
    void complain(SourceLine where, std::string what) { problems_.add(std::move(where), std::move(what)); }
    /// To be called with the text of every entry that outlives the call, whatever holds it: Lua's own limit doesn't
    /// count those. Throws Error when there are too many.
    void remember(const std::string& text);

    Sandbox& sandbox_;
    lua_State* const L_;
    ProblemList problems_;

private:
    static Globals& self(lua_State* L);
    static int read_global(lua_State* L);
    static int write_global(lua_State* L);
    static int call_unknown(lua_State* L);

    void install();
    int read(lua_State* L);
    int write(lua_State* L);
    void override_constant(lua_State* L, const std::string& name);

    const std::map<std::string, std::string> overrides_;  // -D
    std::map<std::string, bool> met_;                     // overrides that the file reads or gives
    std::map<std::string, SourceLine> constants_;         // constants of the file
    std::vector<Unknown> unknowns_;
    std::size_t remembered_ = 0;  // bytes
};

}  // namespace lightnet::lua
