// Builds tables of rules. Each rule (row) binds a key to the struct member that it fills. Code that does not depend on
// the type of the struct is in table_builder.cpp, so that it is compiled only once.
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "film/scene/rule.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

// These functions convert a struct member to a Value.
Value to_value(double number);
Value to_value(int number);
Value to_value(bool flag);
Value to_value(const std::string& text);
Value to_value(const std::vector<std::string>& texts);
Value to_value(const std::filesystem::path& path);
Value to_value(const Vec2& v);
Value to_value(const Vec3& v);
Value to_value(const Quat& q);
Value to_value(const std::vector<Vec3>& points);
template <class T>
Value to_value(const std::optional<T>& value) {
  return value ? to_value(*value) : Value{};
}

// These functions convert a Value to a struct member. Reader has already checked type, range and number of components.
void assign(double& target, const Value& value);
void assign(int& target, const Value& value);
void assign(bool& target, const Value& value);
void assign(std::string& target, const Value& value);
void assign(std::vector<std::string>& target, const Value& value);
void assign(std::filesystem::path& target, const Value& value);
void assign(Vec2& target, const Value& value);
void assign(Vec3& target, const Value& value);
void assign(Quat& target, const Value& value);
void assign(std::vector<Vec3>& target, const Value& value);
template <class T>
void assign(std::optional<T>& target, const Value& value) {
  assign(target.emplace(), value);
}

/// Names of choices or components.
struct Names {
  Names(std::initializer_list<std::string_view> names);
  Names(const std::vector<std::string>& names);
  ~Names();
  std::vector<std::string> list;
};

/// The part of TableBuilder that does not depend on the struct.
class RowBuilder {
 public:
  RowBuilder(const RowBuilder&) = delete;
  Table build() { return std::move(table_); }

 protected:
  using Flag = std::function<bool(void*)>;

  explicit RowBuilder(std::string_view documentation);
  ~RowBuilder();

  Rule& last() { return table_.rules.back(); }
  void add(std::string_view key, Type type, std::string_view documentation);
  void add_number(std::string_view key, Range range, std::string_view unit, std::string_view documentation);
  void add_table(std::string_view key, Type type, const Table& inner);
  void set_components(const Names& components);
  void bind(std::function<Value(void*)> get, std::function<void(void*, const Value&)> set);
  /// Binds a choice. The functions read and write the index of the chosen name in `choices`.
  void bind_choice(const Names& choices, std::function<std::size_t(void*)> get,
                   std::function<void(void*, std::size_t)> set);
  void add_variant(std::string_view name, const RowBuilder& rows);
  void write_if(Flag when);
  void do_when_given(std::function<void(void*)> then);

  Table table_;
};

/// Builds the table that describes struct S. An argument `member` is a pointer to a member of S, or a function that
/// takes S& and returns a reference to a member.
template <class S>
class TableBuilder : public RowBuilder {
 public:
  explicit TableBuilder(std::string_view documentation = {}) : RowBuilder(documentation) {
    table_.make = [] { return std::make_shared<S>(); };
  }

  template <class Member>
  TableBuilder& number(std::string_view key, Member member, Range range, std::string_view unit,
                       std::string_view documentation) {
    add_number(key, range, unit, documentation);
    return bind_member(member);
  }
  template <class Member>
  TableBuilder& whole_number(std::string_view key, Member member, Range range, std::string_view documentation) {
    return number(key, member, range, "", documentation).whole();
  }
  template <class Member>
  TableBuilder& vector(std::string_view key, Member member, const Names& components, Range range, std::string_view unit,
                       std::string_view documentation) {
    number(key, member, range, unit, documentation);
    set_components(components);
    return *this;
  }
  /// A list of points.
  template <class Member>
  TableBuilder& points(std::string_view key, Member member, const Names& components, Range range, std::string_view unit,
                       std::string_view documentation) {
    vector(key, member, components, range, unit, documentation);
    last().type = Type::points;
    return *this;
  }
  template <class Member>
  TableBuilder& color(std::string_view key, Member member, std::string_view documentation) {
    vector(key, member, {"r", "g", "b"}, within(0, 1), "", documentation);
    last().type = Type::color;
    return *this;
  }
  /// A flag, text, list of texts, name or file.
  template <class Member>
  TableBuilder& plain(Type type, std::string_view key, Member member, std::string_view documentation) {
    add(key, type, documentation);
    return bind_member(member);
  }
  /// A choice, stored as an enumeration, an index or a bool. `choices`: in the order of the enumeration, or for false
  /// and true.
  template <class Member>
  TableBuilder& choice(std::string_view key, Member member, const Names& choices, std::string_view documentation) {
    using Field = std::remove_reference_t<std::invoke_result_t<Member, S&>>;
    return choice_by(
        key, choices, documentation, [member](S& s) { return static_cast<std::size_t>(std::invoke(member, s)); },
        [member](S& s, std::size_t index) { std::invoke(member, s) = static_cast<Field>(index); });
  }
  /// A choice that no single member stores. The functions read (S&) and write (S&, std::size_t) the
  /// index of the chosen name in `choices`.
  template <class Get, class Set>
  TableBuilder& choice_by(std::string_view key, const Names& choices, std::string_view documentation, Get get,
                          Set set) {
    add(key, Type::choice, documentation);
    bind_choice(
        choices, [get](void* s) { return get(*static_cast<S*>(s)); },
        [set](void* s, std::size_t index) { set(*static_cast<S*>(s), index); });
    return *this;
  }
  /// A number, or one of `names`. The functions read (S&) and write (S&, const Value&) the number or the name.
  template <class Get, class Set>
  TableBuilder& number_or(std::string_view key, const Names& names, Range range, std::string_view unit,
                          std::string_view documentation, Get get, Set set) {
    add_number(key, range, unit, documentation);
    last().choices = names.list;
    bind([get](void* s) -> Value { return get(*static_cast<S*>(s)); },
         [set](void* s, const Value& value) { set(*static_cast<S*>(s), value); });
    return *this;
  }
  /// One array [weft, warp] for two members; a single number sets both.
  template <class First, class Second>
  TableBuilder& pair(std::string_view key, First first, Second second, Range range, std::string_view unit,
                     std::string_view documentation) {
    add_number(key, range, unit, documentation);
    set_components({"weft", "warp"});
    bind(
        [first, second](void* p) {
          S& s = *static_cast<S*>(p);
          return to_value(Vec2(std::invoke(first, s), std::invoke(second, s)));
        },
        [first, second](void* p, const Value& value) {
          const auto& both = std::get<std::vector<double>>(value);
          S& s = *static_cast<S*>(p);
          assign(std::invoke(first, s), Value(std::vector{both[0]}));
          assign(std::invoke(second, s), Value(std::vector{both[1]}));
        });
    return single_fills_all();
  }

  template <class Member>
  TableBuilder& table(std::string_view key, Member member, const Table& inner) {
    add_table(key, Type::table, inner);
    last().inner = [member](void* s) -> void* { return &std::invoke(member, *static_cast<S*>(s)); };
    return *this;
  }
  /// A list of tables stored in a vector.
  template <class Member>
  TableBuilder& list(Type type, std::string_view key, Member member, const Table& entries) {
    return list(type, key, member, entries, [member](S& s, std::size_t) { std::invoke(member, s).emplace_back(); });
  }
  /// `make_entry` (S&, std::size_t) appends entry i, filled with its defaults, to the vector.
  template <class Member, class Make>
  TableBuilder& list(Type type, std::string_view key, Member member, const Table& entries, Make make_entry) {
    add_table(key, type, entries);
    Rule& rule = last();
    rule.range = within(0, type == Type::keys ? 100000 : 1000);
    rule.count = [member](void* s) { return std::invoke(member, *static_cast<S*>(s)).size(); };
    rule.entry = [member](void* s, std::size_t i) -> void* { return &std::invoke(member, *static_cast<S*>(s))[i]; };
    rule.append = [member, make_entry](void* p, std::size_t i) -> void* {
      S& s = *static_cast<S*>(p);
      make_entry(s, i);
      return &std::invoke(member, s).back();
    };
    return *this;
  }
  /// Rows that apply only if the selector has the value `name`.
  TableBuilder& variant(std::string_view name, const RowBuilder& rows) {
    add_variant(name, rows);
    return *this;
  }

  // The functions from here to written_if() modify the row added last.
  TableBuilder& need(Need need) {
    last().need = need;
    return *this;
  }
  TableBuilder& by_default(std::string_view note) {
    last().default_note = note;
    return *this;
  }
  TableBuilder& whole() {
    last().whole = true;
    return *this;
  }
  TableBuilder& single_fills_all() {
    last().single_fills_all = true;
    return *this;
  }
  TableBuilder& nonzero() {
    last().nonzero = true;
    return *this;
  }
  TableBuilder& excludes(std::string_view key) {
    last().excludes = key;
    return *this;
  }
  /// `then` (S&): additional action if the scene gives the key.
  template <class Then>
  TableBuilder& when_given(Then then) {
    do_when_given([then](void* s) { then(*static_cast<S*>(s)); });
    return *this;
  }
  TableBuilder& not_simulated() {
    last().simulated = false;
    return *this;
  }
  TableBuilder& selects() {
    table_.selector = last().key;
    return *this;
  }
  /// `when` (S&): whether the effective scene contains the key if it has a value.
  template <class When>
  TableBuilder& written_if(When when) {
    write_if([when](void* s) { return when(*static_cast<S*>(s)); });
    return *this;
  }

  /// `start`: the struct with its defaults, if they differ from S{}.
  TableBuilder& starting_from(S start) {
    table_.make = [start] { return std::make_shared<S>(start); };
    return *this;
  }
  /// Calls `rows` (TableBuilder&), a function that adds rows.
  template <class Rows>
  TableBuilder& with(const Rows& rows) {
    rows(*this);
    return *this;
  }

 private:
  template <class Member>
  TableBuilder& bind_member(Member member) {
    bind([member](void* s) { return to_value(std::invoke(member, *static_cast<S*>(s))); },
         [member](void* s, const Value& value) { assign(std::invoke(member, *static_cast<S*>(s)), value); });
    return *this;
  }
};

}  // namespace weft::scene
