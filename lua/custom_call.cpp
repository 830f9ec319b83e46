#include "lua/custom_call.hpp"

#include <lua_any.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/unwanted.hpp"
#include "lua/column.hpp"
#include "lua/guarded.hpp"

namespace lightnet::lua {
namespace {

constexpr int steps_at_once = 1000;  // between two looks at the budget
constexpr std::int64_t steps_of_a_call = 10'000'000, steps_of_a_question = 20'000;
constexpr std::int64_t bytes_of_a_step = 64, steps_of_an_ask = 8;
// One instruction copies or compares so much at most: of texts, and of anything else, such as the arguments of a call.
constexpr std::size_t longest_text = 4096, largest_piece = std::size_t{256} << 10;
constexpr std::size_t bytes_of_a_call = std::size_t{32} << 20, bytes_of_a_question = 16384;

// What of Lua's own is left: nothing that reaches out, remembers, goes by addresses, or asks the mathematical library.
constexpr const char* base_names[] = {"assert", "error", "ipairs", "select", "type"};
constexpr const char* exact_names[] = {"abs", "ceil", "floor", "max", "min", "sqrt", "huge", "pi", "tointeger", "ult"};

// Copies entries of the table on top of the stack into the one below it, and takes it away.
template <std::size_t size>
void take_names(lua_State* L, const char* const (&names)[size]) {
    for (const char* const name : names) {
        lua_getfield(L, -1, name);
        lua_setfield(L, -3, name);
    }
    lua_pop(L, 1);
}

void set_vectors(ColumnHead& column, std::size_t i, Vec3 v) {
    column.part(0)[i] = v.x, column.part(1)[i] = v.y, column.part(2)[i] = v.z;
}
Vec3 vector_at(ColumnHead& column, std::size_t i) { return {column.part(0)[i], column.part(1)[i], column.part(2)[i]}; }

ColumnHead& column_argument(lua_State* L, int index, std::size_t width, const char* what) {
    auto* const column = column_at(L, index);
    if (!column || column->width != width) luaL_error(L, "wants %s as argument %d", what, index - 1);
    return *column;
}

// '^' is pow() of the mathematical library, which differs from one to the next. Behind strings and comments.
int line_of_power(std::string_view source) {
    int line = 1;
    for (std::size_t i = 0; i < source.size(); ++i) {
        const char c = source[i];
        if (c == '\n') ++line;
        if (c == '-' && source.substr(i, 2) == "--" && source.substr(i, 4) != "--[[")
            i = std::min(source.find('\n', i), source.size()) - 1;
        else if (c == '"' || c == '\'') {
            for (++i; i < source.size() && source[i] != c && source[i] != '\n'; ++i)
                if (source[i] == '\\') ++i;
        } else if (c == '^')
            return line;
    }
    return 0;
}

std::string chunk_name(const std::string& file) { return "=" + file; }

}  // namespace

CustomBudget CustomBudget::of(std::size_t questions) {
    return {steps_of_a_call + static_cast<std::int64_t>(questions) * steps_of_a_question,
            bytes_of_a_call + questions * bytes_of_a_question};
}

void CustomCall::Close::operator()(lua_State* L) const { lua_close(L); }

CustomCall::CustomCall(const CustomProgram& program, std::span<const Query> questions)
    : program_(program),
      questions_(*program.scene, program.inputs, program.key, questions),
      left_(CustomBudget::of(questions.size())) {
    state_.reset(lua_newstate(&CustomCall::allocate, this));
    if (!state_) throw Error(program.file, "no memory for a Lua state");
    *static_cast<CustomCall**>(lua_getextraspace(state_.get())) = this;
}

CustomCall::~CustomCall() = default;

CustomCall& CustomCall::of(lua_State* L) { return **static_cast<CustomCall**>(lua_getextraspace(L)); }

void* CustomCall::allocate(void* self, void* block, std::size_t old_size, std::size_t new_size) {
    auto& call = *static_cast<CustomCall*>(self);
    auto& left = call.left_.memory;
    const bool text = !block && old_size == LUA_TSTRING, column = !block && old_size == LUA_TUSERDATA;
    if (!block) old_size = 0;  // else it tells what is made, not how large it was
    if (new_size == 0) {
        std::free(block);
        left += old_size;
        return nullptr;
    }
    if (!column && new_size > old_size) {
        const std::size_t most = text ? longest_text : largest_piece;
        if (new_size > most) call.too_large_ = text ? "a text" : "a table, or arguments of a call,";
        if (new_size > most) return nullptr;
        call.left_.steps -= static_cast<std::int64_t>(new_size) / bytes_of_a_step;  // the hook looks at it
    }
    if (new_size > old_size && new_size - old_size > left) return nullptr;
    void* const moved = std::realloc(block, new_size);
    if (moved) left -= new_size - old_size;
    return moved;
}

// `level`: how far above what runs now the line stands that is at fault.
void CustomCall::spend(lua_State* L, std::int64_t steps, int level) {
    left_.steps -= steps;
    if (is_unwanted()) luaL_error(L, "is no longer wanted");
    if (left_.steps >= 0) return;
    luaL_where(L, level);
    lua_pushstring(L, too_many_steps().c_str());
    lua_concat(L, 2);
    lua_error(L);
}

std::string CustomCall::too_many_steps() const {
    return "takes more than " + std::to_string(CustomBudget::of(questions_.size()).steps) + " steps for " +
           std::to_string(questions_.size()) + " questions";
}

void CustomCall::count(lua_State* L, lua_Debug*) { of(L).spend(L, steps_at_once, 0); }
void CustomCall::charge(lua_State* L, std::size_t entries) {
    of(L).spend(L, static_cast<std::int64_t>(entries) / 4, 1);
}

// q.p, q.n, q.out, q.albedo, and q's functions
int CustomCall::member(lua_State* L) {
    auto& call = of(L);
    const std::string_view name = luaL_checkstring(L, 2);
    if (name == "random" || name == "open") {
        lua_pushcfunction(L, name == "open" ? &CustomCall::is_open : &CustomCall::random);
        return 1;
    }
    const bool known = name == "p" || name == "n" || name == "out" || name == "albedo";
    if (!known) return luaL_error(L, "a question has p, n, out, albedo, random() and open(), and no '%s'", name.data());
    return guarded(L, [&] {
        const std::size_t count = call.questions_.size();
        charge(L, 3 * count);
        const auto& places = call.questions_.places();
        ColumnHead& column = push_column(L, 3, count);
        for (std::size_t i = 0; i < count; ++i) {
            const auto& [point, up] = places[i];
            if (name == "albedo") {
                const Rgb albedo = call.questions_.albedo(i);
                set_vectors(column, i, {albedo.r, albedo.g, albedo.b});
            } else
                set_vectors(column, i, name == "p" ? point.position : name == "n" ? up : call.questions_[i].outgoing);
        }
        return 1;
    });
}

// q:random(i, n): point i of n of each question, counted from 1; well spread over all samples of a pixel.
int CustomCall::random(lua_State* L) {
    auto& call = of(L);
    const auto of_how_many = luaL_optinteger(L, 3, 1), which = luaL_optinteger(L, 2, 1);
    if (of_how_many < 1 || of_how_many > 65536 || which < 1 || which > of_how_many)
        return luaL_error(L, "q:random(i, n) gives point i of n, from 1 to n, and n is at most 65536");
    const std::size_t count = call.questions_.size();
    charge(L, 8 * count);
    ColumnHead& column = push_column(L, 2, count);
    for (std::size_t k = 0; k < count; ++k) {
        const Vec2 point =
            call.questions_.random(k, static_cast<std::uint32_t>(which - 1), static_cast<std::uint32_t>(of_how_many));
        column.part(0)[k] = point.x, column.part(1)[k] = point.y;
    }
    return 1;
}

// hemisphere(n, u): directions around n, as many as their cosine
int CustomCall::hemisphere(lua_State* L) {
    auto* const normals = column_at(L, 1);
    auto* const points = column_at(L, 2);
    if (!normals || normals->width != 3 || !points || points->width != 2)
        return luaL_error(L, "hemisphere(normals, points) wants q.n and q:random(i, n), or columns like them");
    charge(L, 8 * normals->count);
    ColumnHead& column = push_column(L, 3, normals->count);
    for (std::size_t k = 0; k < normals->count; ++k)
        set_vectors(column, k,
                    Frame::around(vector_at(*normals, k))
                        .to_world(cosine_hemisphere({points->part(0)[k], points->part(1)[k]})));
    return 1;
}

// q:open(d, distance): 1 where nothing is in the way, else 0
int CustomCall::is_open(lua_State* L) {
    auto& call = of(L);
    ColumnHead& directions = column_argument(L, 2, 3, "directions");
    const double distance = luaL_optnumber(L, 3, 0);
    return guarded(L, [&] {
        const std::size_t count = call.questions_.size();
        charge(L, 200 * count);
        ColumnHead& column = push_column(L, 1, count);
        for (std::size_t k = 0; k < count; ++k)
            column.data()[k] =
                call.questions_.open(k, vector_at(directions, k), static_cast<float>(distance)) ? 1.0f : 0.0f;
        return 1;
    });
}

void CustomCall::open(lua_State* L) {
    luaL_requiref(L, LUA_GNAME, luaopen_base, 0);
    lua_newtable(L);
    lua_insert(L, -2);
    take_names(L, base_names);
    lua_newtable(L);
    luaL_requiref(L, LUA_MATHLIBNAME, luaopen_math, 0);
    take_names(L, exact_names);
    lua_setfield(L, -2, "math");
    open_columns(L, &CustomCall::charge);
    lua_pushcfunction(L, &CustomCall::hemisphere);
    lua_setfield(L, -2, "hemisphere");
    lua_rawseti(L, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
}

void CustomCall::fail(lua_State* L, int status) {
    end_if_unwanted();
    if (status != LUA_ERRMEM) {
        const char* const text = lua_tostring(L, -1);
        throw Error(text ? text : program_.file + ": an error that is no text");
    }
    lua_Debug info{};  // the stack is as it was when there was no memory
    int line = 0;
    for (int level = 0; line <= 0 && lua_getstack(L, level, &info); ++level)
        if (lua_getinfo(L, "l", &info)) line = info.currentline;
    const std::string where = program_.file + ":" + std::to_string(line) + ": ";
    if (too_large_) {
        const bool text = std::string_view(too_large_) == "a text";
        throw Error(where + "makes " + too_large_ + " of more than " +
                    std::to_string((text ? longest_text : largest_piece) >> 10) + " KiB");
    }
    throw Error(where + "takes more than " + std::to_string(CustomBudget::of(questions_.size()).memory >> 20) +
                " MiB for " + std::to_string(questions_.size()) + " questions");
}

// ask(i): what input i says of the same questions. ask(i, d): the light that comes from there, which some surface has
// scattered. Called while Lua stands still; leaves the answer on the stack.
void CustomCall::ask(lua_State* L, int arguments) {
    const auto complain = [&](const std::string& what) {
        lua_Debug info{};
        const bool known = lua_getstack(L, 1, &info) && lua_getinfo(L, "l", &info);
        throw Error(program_.file + ":" + std::to_string(known ? info.currentline : 0) + ": " + what);
    };
    const int first = lua_gettop(L) - arguments + 1;
    const auto index = arguments > 0 && lua_isinteger(L, first) ? lua_tointeger(L, first) : 0;
    if (index < 1 || index > static_cast<lua_Integer>(program_.inputs.size()))
        complain("ask(i) asks input i, from 1 to " + std::to_string(program_.inputs.size()));
    auto* const directions = arguments > 1 ? column_at(L, first + 1) : nullptr;
    if (arguments > 1 && (!directions || directions->width != 3)) complain("ask(i, d) wants directions");
    const std::size_t count = questions_.size(), input = static_cast<std::size_t>(index - 1);
    left_.steps -= steps_of_an_ask * static_cast<std::int64_t>(count);
    if (left_.steps < 0) complain(too_many_steps());
    std::vector<Rgb> light;
    if (directions) {
        std::vector<Vec3> ways(count);
        for (std::size_t k = 0; k < count; ++k) ways[k] = vector_at(*directions, k);
        light = questions_.ask(input, ways);
    } else {
        light = questions_.ask(input);
    }
    lua_settop(L, first - 1);
    ColumnHead& column = push_column(L, 3, count);
    for (std::size_t k = 0; k < count; ++k) set_vectors(column, k, {light[k].r, light[k].g, light[k].b});
}

// Steps from one question to an input to the next; the function's value is then on the stack.
void CustomCall::run(lua_State* L) {
    int given = 0;
    int status = lua_resume(L, state_.get(), 2, &given);
    while (status == LUA_YIELD) {
        ask(L, given);
        status = lua_resume(L, state_.get(), 1, &given);
    }
    if (status != LUA_OK) fail(L, status);
}

void CustomCall::answer(std::span<Rgb> answers) {
    lua_State* const L = state_.get();
    const auto prepare = [](lua_State* state) {
        auto& call = of(state);
        call.open(state);
        const auto& [node, file, source, scene, inputs, key] = call.program_;
        if (luaL_loadbufferx(state, source.data(), source.size(), chunk_name(file).c_str(), "t") != LUA_OK)
            return lua_error(state);
        lua_call(state, 0, 1);
        luaL_checktype(state, -1, LUA_TFUNCTION);
        lua_newtable(state);
        lua_newtable(state);
        lua_pushcfunction(state, &CustomCall::member);
        lua_setfield(state, -2, "__index");
        lua_setmetatable(state, -2);
        lua_pushcfunction(state, [](lua_State* asking) { return lua_yield(asking, lua_gettop(asking)); });
        return 3;
    };
    lua_State* const thread = lua_newthread(L);
    lua_sethook(L, &CustomCall::count, LUA_MASKCOUNT, steps_at_once);
    lua_sethook(thread, &CustomCall::count, LUA_MASKCOUNT, steps_at_once);
    lua_pushcfunction(L, prepare);
    if (const int status = lua_pcall(L, 0, 3, 0); status != LUA_OK) fail(L, status);
    lua_xmove(L, thread, 3);
    run(thread);
    const std::size_t count = questions_.size();
    if (auto* const column = column_at(thread, -1); column && column->count == count && column->width != 2) {
        for (std::size_t k = 0; k < count; ++k) {
            const float grey = column->data()[k];
            answers[k] = column->width == 1 ? Rgb{grey, grey, grey}
                                            : Rgb{column->part(0)[k], column->part(1)[k], column->part(2)[k]};
        }
    } else if (lua_type(thread, -1) == LUA_TNUMBER) {
        const auto grey = static_cast<float>(lua_tonumber(thread, -1));
        std::fill(answers.begin(), answers.end(), Rgb{grey, grey, grey});
    } else {
        throw Error(program_.file, "'" + program_.node +
                                       "' returns a column of numbers or colours, or one number, not a " +
                                       luaL_typename(thread, -1));
    }
}

std::string CustomCall::mistake_in(const std::string& source, const std::string& file) {
    if (const int line = line_of_power(source))
        return file + ":" + std::to_string(line) + ": '^' is not the same on all hosts: multiply, or take sqrt()";
    const std::unique_ptr<lua_State, Close> state(luaL_newstate());
    if (!state) return "";
    if (luaL_loadbufferx(state.get(), source.data(), source.size(), chunk_name(file).c_str(), "t") == LUA_OK) return "";
    return lua_tostring(state.get(), -1);
}

}  // namespace lightnet::lua
