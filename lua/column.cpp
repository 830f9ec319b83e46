#include "lua/column.hpp"

#include <lua_any.hpp>

#include <algorithm>
#include <cmath>

namespace lightnet::lua {
namespace {

constexpr const char* column_type = "lightnet.column";
constexpr const char* charge_key = "lightnet.charge";
using Charge = void (*)(lua_State*, std::size_t);

void charge(lua_State* L, std::size_t entries) {
    lua_getfield(L, LUA_REGISTRYINDEX, charge_key);
    const auto function = reinterpret_cast<Charge>(lua_touserdata(L, -1));
    lua_pop(L, 1);
    function(L, entries);
}

/// An operand: a column, or a number for all entries.
struct Operand {
    ColumnHead* column = nullptr;
    float number = 0;

    std::size_t width() const { return column ? column->width : 1; }
};

Operand operand_at(lua_State* L, int index) {
    if (auto* const column = column_at(L, index)) return {column, 0};
    if (lua_type(L, index) == LUA_TNUMBER) return {nullptr, static_cast<float>(lua_tonumber(L, index))};
    luaL_error(L, "wants a column or a number, not a %s", luaL_typename(L, index));
    return {};
}

std::size_t common_count(lua_State* L, std::initializer_list<Operand> operands) {
    for (const auto& one : operands)
        if (one.column) return one.column->count;
    luaL_error(L, "wants a column among its arguments");
    return 0;
}

std::size_t common_width(lua_State* L, std::initializer_list<Operand> operands) {
    std::size_t width = 1;
    for (const auto& one : operands) {
        if (one.width() == 1) continue;
        if (width != 1 && width != one.width())
            luaL_error(L, "columns of %d and %d numbers don't go together", static_cast<int>(width),
                       static_cast<int>(one.width()));
        width = one.width();
    }
    return width;
}

// part `i` of an operand for all entries, copied into `room` where it is one number
const float* part_of(const Operand& operand, std::size_t i) {
    return operand.column ? operand.column->part(operand.column->width == 1 ? 0 : i) : nullptr;
}

template <class Work>
void each_entry(const Operand& a, const Operand& b, std::size_t i, float* out, std::size_t count, Work work) {
    const float* const left = part_of(a, i);
    const float* const right = part_of(b, i);
    if (left && right)
        for (std::size_t k = 0; k < count; ++k) out[k] = work(left[k], right[k]);
    else if (left)
        for (std::size_t k = 0; k < count; ++k) out[k] = work(left[k], b.number);
    else
        for (std::size_t k = 0; k < count; ++k) out[k] = work(a.number, right[k]);
}

template <class Work>
int binary(lua_State* L, Work work) {
    const Operand a = operand_at(L, 1), b = operand_at(L, 2);
    const std::size_t count = common_count(L, {a, b}), width = common_width(L, {a, b});
    charge(L, count * width);
    ColumnHead& out = push_column(L, width, count);
    for (std::size_t i = 0; i < width; ++i) each_entry(a, b, i, out.part(i), count, work);
    return 1;
}

template <class Work>
int unary(lua_State* L, Work work) {
    const Operand a = operand_at(L, 1);
    const std::size_t count = common_count(L, {a}), width = a.width();
    charge(L, count * width);
    ColumnHead& out = push_column(L, width, count);
    for (std::size_t k = 0; k < count * width; ++k) out.data()[k] = work(a.column->data()[k]);
    return 1;
}

ColumnHead& vectors_at(lua_State* L, int index) {
    auto* const column = column_at(L, index);
    if (!column || column->width != 3) luaL_error(L, "wants a column of vectors as argument %d", index);
    return *column;
}

int add_columns(lua_State* L) {
    return binary(L, [](float a, float b) { return a + b; });
}
int subtract(lua_State* L) {
    return binary(L, [](float a, float b) { return a - b; });
}
int multiply(lua_State* L) {
    return binary(L, [](float a, float b) { return a * b; });
}
int divide(lua_State* L) {
    return binary(L, [](float a, float b) { return a / b; });
}
int minimum(lua_State* L) {
    return binary(L, [](float a, float b) { return b < a ? b : a; });
}
int maximum(lua_State* L) {
    return binary(L, [](float a, float b) { return a < b ? b : a; });
}
int less(lua_State* L) {
    return binary(L, [](float a, float b) { return a < b ? 1.0f : 0.0f; });
}
int negate(lua_State* L) {
    return unary(L, [](float a) { return -a; });
}
int square_root(lua_State* L) {
    return unary(L, [](float a) { return std::sqrt(a); });
}
int absolute(lua_State* L) {
    return unary(L, [](float a) { return std::fabs(a); });
}
int round_down(lua_State* L) {
    return unary(L, [](float a) { return std::floor(a); });
}

// where(condition, a, b): a where the condition is not 0.
int where(lua_State* L) {
    const Operand condition = operand_at(L, 1), a = operand_at(L, 2), b = operand_at(L, 3);
    const std::size_t count = common_count(L, {condition}), width = common_width(L, {a, b});
    if (condition.width() != 1) luaL_error(L, "the condition is a column of numbers");
    charge(L, count * width);
    ColumnHead& out = push_column(L, width, count);
    for (std::size_t i = 0; i < width; ++i) {
        const float *const yes = part_of(a, i), *const no = part_of(b, i), *const which = condition.column->data();
        for (std::size_t k = 0; k < count; ++k)
            out.part(i)[k] = which[k] != 0 ? (yes ? yes[k] : a.number) : (no ? no[k] : b.number);
    }
    return 1;
}

int dot_product(lua_State* L) {
    ColumnHead &a = vectors_at(L, 1), &b = vectors_at(L, 2);
    charge(L, 3 * a.count);
    ColumnHead& out = push_column(L, 1, a.count);
    for (std::size_t k = 0; k < a.count; ++k)
        out.data()[k] = a.part(0)[k] * b.part(0)[k] + a.part(1)[k] * b.part(1)[k] + a.part(2)[k] * b.part(2)[k];
    return 1;
}

int cross_product(lua_State* L) {
    ColumnHead &a = vectors_at(L, 1), &b = vectors_at(L, 2);
    charge(L, 3 * a.count);
    ColumnHead& out = push_column(L, 3, a.count);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, m = (i + 2) % 3;
        for (std::size_t k = 0; k < a.count; ++k)
            out.part(i)[k] = a.part(j)[k] * b.part(m)[k] - a.part(m)[k] * b.part(j)[k];
    }
    return 1;
}

int length_of(lua_State* L) {
    ColumnHead& a = vectors_at(L, 1);
    charge(L, 3 * a.count);
    ColumnHead& out = push_column(L, 1, a.count);
    for (std::size_t k = 0; k < a.count; ++k) {
        const float x = a.part(0)[k], y = a.part(1)[k], z = a.part(2)[k];
        out.data()[k] = std::sqrt(x * x + y * y + z * z);
    }
    return 1;
}

int normalized(lua_State* L) {
    length_of(L);
    lua_replace(L, 2);
    lua_settop(L, 2);
    return divide(L);
}

// vec(x, y, z), of columns and numbers
int make_vectors(lua_State* L) {
    const Operand parts[] = {operand_at(L, 1), operand_at(L, 2), operand_at(L, 3)};
    const std::size_t count = common_count(L, {parts[0], parts[1], parts[2]});
    charge(L, 3 * count);
    ColumnHead& out = push_column(L, 3, count);
    for (std::size_t i = 0; i < 3; ++i) {
        if (parts[i].width() != 1) luaL_error(L, "a part of a vector is a column of numbers");
        for (std::size_t k = 0; k < count; ++k)
            out.part(i)[k] = parts[i].column ? parts[i].column->data()[k] : parts[i].number;
    }
    return 1;
}

// v.x, v.y, v.z
int part(lua_State* L) {
    ColumnHead& column = *column_at(L, 1);
    const std::string_view name = luaL_checkstring(L, 2);
    const std::size_t i = name == "x" ? 0 : name == "y" ? 1 : name == "z" ? 2 : 3;
    if (i >= column.width)
        luaL_error(L, "a column of %d numbers has no '%s'", static_cast<int>(column.width), name.data());
    ColumnHead& out = push_column(L, 1, column.count);
    std::copy_n(column.part(i), column.count, out.data());
    return 1;
}

}  // namespace

void open_columns(lua_State* L, Charge charge) {
    lua_pushlightuserdata(L, reinterpret_cast<void*>(charge));
    lua_setfield(L, LUA_REGISTRYINDEX, charge_key);
    luaL_newmetatable(L, column_type);
    const luaL_Reg operators[] = {{"__add", add_columns}, {"__sub", subtract}, {"__mul", multiply}, {"__div", divide},
                                  {"__unm", negate},      {"__index", part},   {nullptr, nullptr}};
    luaL_setfuncs(L, operators, 0);
    lua_pushboolean(L, 0);
    lua_setfield(L, -2, "__metatable");
    lua_pushliteral(L, "column");
    lua_setfield(L, -2, "__name");
    lua_pop(L, 1);
    const luaL_Reg functions[] = {
        {"dot", dot_product},  {"cross", cross_product}, {"length", length_of}, {"normalize", normalized},
        {"sqrt", square_root}, {"abs", absolute},        {"floor", round_down}, {"min", minimum},
        {"max", maximum},      {"less", less},           {"where", where},      {"vec", make_vectors},
        {nullptr, nullptr}};
    luaL_setfuncs(L, functions, 0);
}

ColumnHead& push_column(lua_State* L, std::size_t width, std::size_t count) {
    void* const memory = lua_newuserdatauv(L, sizeof(ColumnHead) + width * count * sizeof(float), 0);
    auto* const column = new (memory) ColumnHead{width, count};
    luaL_setmetatable(L, column_type);
    return *column;
}

ColumnHead* column_at(lua_State* L, int index) {
    return static_cast<ColumnHead*>(luaL_testudata(L, index, column_type));
}

}  // namespace lightnet::lua
