// One call of a Lua operator, in a Lua state of its own: so nothing is left of it for the next one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/base/query.hpp"
#include "core/estimate/question_batch.hpp"
#include "core/network/light/inputs.hpp"
#include "core/scene/scene.hpp"

struct lua_Debug;
struct lua_State;

namespace lightnet::lua {

/// What a Lua operator is, for all its calls.
struct CustomProgram {
    std::string node;    // its name
    std::string file;    // where it stands
    std::string source;  // see function_source()
    const Scene* scene = nullptr;
    Inputs inputs;
    Key key = 0;
};

/// What a call may take: instructions of Lua, bytes that these make, or entries of columns; and memory.
struct CustomBudget {
    std::int64_t steps = 0;
    std::size_t memory = 0;
    static CustomBudget of(std::size_t questions);
};

/// Answers questions. Asks inputs from C++ alone, as Lua stands still: so its call may wait while others of this node
/// begin. Throws Error with file and line; and what inputs throw.
class CustomCall {
public:
    CustomCall(const CustomProgram& program, std::span<const Query> questions);
    ~CustomCall();
    CustomCall(const CustomCall&) = delete;
    CustomCall& operator=(const CustomCall&) = delete;

    void answer(std::span<Rgb> answers);

    /// What is wrong with a source, with file and line; "": it is a function.
    static std::string mistake_in(const std::string& source, const std::string& file);

private:
    struct Close {
        void operator()(lua_State* L) const;
    };
    static CustomCall& of(lua_State* L);
    static void* allocate(void* self, void* block, std::size_t old_size, std::size_t new_size);
    static void count(lua_State* L, lua_Debug* event);
    static void charge(lua_State* L, std::size_t entries);
    static int member(lua_State* L);
    static int random(lua_State* L);
    static int hemisphere(lua_State* L);
    static int is_open(lua_State* L);

    void spend(lua_State* L, std::int64_t steps, int level);
    void open(lua_State* L);
    void run(lua_State* L);
    void ask(lua_State* L, int arguments);
    [[noreturn]] void fail(lua_State* L, int status);
    std::string too_many_steps() const;

    const CustomProgram& program_;
    QuestionBatch questions_;
    CustomBudget left_;
    const char* too_large_ = nullptr;  // a piece of memory that there was none for
    std::unique_ptr<lua_State, Close> state_;
};

}  // namespace lightnet::lua
