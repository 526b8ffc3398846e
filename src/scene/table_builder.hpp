// Writes rows of the rule table: binds a key to the member of a struct it fills.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/rule.hpp"
#include "scene/scene.hpp"

namespace weft::scene {

// Struct member -> Value. Adding 0.0 turns -0 into 0, which TOML would write and read back differently.
inline Value to_value(double number) {
  return std::vector<double>{number + 0.0};
}
inline Value to_value(int number) {
  return std::vector<double>{static_cast<double>(number)};
}
inline Value to_value(bool flag) {
  return flag;
}
inline Value to_value(const std::string& text) {
  return text;
}
inline Value to_value(const std::vector<std::string>& texts) {
  return texts.empty() ? Value{} : texts;
}
inline Value to_value(const std::filesystem::path& path) {
  return path.string();
}
inline Value to_value(const Vec2& v) {
  return std::vector<double>{v.x() + 0.0, v.y() + 0.0};
}
inline Value to_value(const Vec3& v) {
  return std::vector<double>{v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};
}
inline Value to_value(const Quat& q) {
  return std::vector<double>{q.w() + 0.0, q.x() + 0.0, q.y() + 0.0, q.z() + 0.0};
}
template <class T>
Value to_value(const std::optional<T>& value) {
  return value ? to_value(*value) : Value{};
}

// Value -> struct member. The reader has checked type, range and number of components.
inline const std::vector<double>& numbers_of(const Value& value) {
  return std::get<std::vector<double>>(value);
}
inline void assign(double& target, const Value& value) {
  target = numbers_of(value)[0];
}
inline void assign(int& target, const Value& value) {
  target = static_cast<int>(numbers_of(value)[0]);
}
inline void assign(bool& target, const Value& value) {
  target = std::get<bool>(value);
}
inline void assign(std::string& target, const Value& value) {
  target = std::get<std::string>(value);
}
inline void assign(std::vector<std::string>& target, const Value& value) {
  target = std::get<std::vector<std::string>>(value);
}
inline void assign(std::filesystem::path& target, const Value& value) {
  target = std::get<std::string>(value);
}
inline void assign(Vec2& target, const Value& value) {
  target = Vec2(numbers_of(value).data());
}
inline void assign(Vec3& target, const Value& value) {
  target = Vec3(numbers_of(value).data());
}
void assign(Quat& target, const Value& value);
template <class T>
void assign(std::optional<T>& target, const Value& value) {
  assign(target.emplace(), value);
}

/// Rows of the table that describes struct S. A member is a member pointer or a generic lambda S& -> member&.
template <class S>
class TableBuilder {
 public:
  explicit TableBuilder(std::string documentation = {}) {
    table_.documentation = std::move(documentation);
    table_.make = [] { return std::make_shared<S>(); };
  }

  template <class Member>
  TableBuilder& number(std::string key, Member member, Range range, std::string unit, std::string documentation) {
    Rule& rule = bind(std::move(key), Type::number, member, std::move(documentation));
    rule.range = range;
    rule.unit = std::move(unit);
    return *this;
  }
  template <class Member>
  TableBuilder& whole_number(std::string key, Member member, Range range, std::string documentation) {
    return number(std::move(key), member, range, "", std::move(documentation)).whole();
  }
  template <class Member>
  TableBuilder& vector(std::string key, Member member, std::vector<std::string> components, Range range,
                       std::string unit, std::string documentation) {
    number(std::move(key), member, range, std::move(unit), std::move(documentation));
    last().components = std::move(components);
    return *this;
  }
  template <class Member>
  TableBuilder& color(std::string key, Member member, std::string documentation) {
    Rule& rule = bind(std::move(key), Type::color, member, std::move(documentation));
    rule.components = {"r", "g", "b"};
    rule.range = within(0, 1);
    return *this;
  }
  /// A flag, text, list of texts, name or file.
  template <class Member>
  TableBuilder& plain(Type type, std::string key, Member member, std::string documentation) {
    bind(std::move(key), type, member, std::move(documentation));
    return *this;
  }
  /// An enumeration (or a bool: false is the first); the choices in the order of its values.
  template <class Member>
  TableBuilder& choice(std::string key, Member member, std::vector<std::string> choices, std::string documentation) {
    using Field = std::remove_reference_t<std::invoke_result_t<Member, S&>>;
    return choice_by(
        std::move(key), std::move(choices), std::move(documentation),
        [member](S& s) { return static_cast<std::size_t>(std::invoke(member, s)); },
        [member](S& s, std::size_t index) { std::invoke(member, s) = static_cast<Field>(index); });
  }
  /// A choice kept in some other way: the functions give and take its index.
  TableBuilder& choice_by(std::string key, std::vector<std::string> choices, std::string documentation,
                          std::function<std::size_t(S&)> get, std::function<void(S&, std::size_t)> set) {
    Rule& rule = add(std::move(key), Type::choice, std::move(documentation));
    rule.get = [get, choices](void* s) { return Value(choices.at(get(*static_cast<S*>(s)))); };
    rule.set = [set, choices](void* s, const Value& value) {
      const auto found = std::find(choices.begin(), choices.end(), std::get<std::string>(value));
      set(*static_cast<S*>(s), static_cast<std::size_t>(found - choices.begin()));
    };
    rule.choices = std::move(choices);
    return *this;
  }
  /// A number, or a word in its place; the functions give and take either.
  TableBuilder& number_or(std::string key, std::vector<std::string> words, Range range, std::string unit,
                          std::string documentation, std::function<Value(S&)> get,
                          std::function<void(S&, const Value&)> set) {
    Rule& rule = add(std::move(key), Type::number, std::move(documentation));
    rule.choices = std::move(words);
    rule.range = range;
    rule.unit = std::move(unit);
    rule.get = [get](void* s) { return get(*static_cast<S*>(s)); };
    rule.set = [set](void* s, const Value& value) { set(*static_cast<S*>(s), value); };
    return *this;
  }
  /// One array for two members; a single number sets both.
  template <class First, class Second>
  TableBuilder& pair(std::string key, First first, Second second, Range range, std::string unit,
                     std::string documentation) {
    Rule& rule = add(std::move(key), Type::number, std::move(documentation));
    rule.get = [first, second](void* p) {
      S& s = *static_cast<S*>(p);
      return Value(std::vector<double>{numbers_of(to_value(std::invoke(first, s)))[0],
                                       numbers_of(to_value(std::invoke(second, s)))[0]});
    };
    rule.set = [first, second](void* p, const Value& value) {
      S& s = *static_cast<S*>(p);
      assign(std::invoke(first, s), Value(std::vector<double>{numbers_of(value)[0]}));
      assign(std::invoke(second, s), Value(std::vector<double>{numbers_of(value)[1]}));
    };
    rule.components = {"weft", "warp"};
    rule.single_fills_all = true;
    rule.range = range;
    rule.unit = std::move(unit);
    return *this;
  }

  template <class Member>
  TableBuilder& table(std::string key, Member member, const Table& inner) {
    Rule& rule = add(std::move(key), Type::table, inner.documentation);
    rule.table = &inner;
    rule.inner = [member](void* s) -> void* { return &std::invoke(member, *static_cast<S*>(s)); };
    return *this;
  }
  /// A list of tables kept in a vector; `make_entry` puts entry i, filled with its defaults, at the end of the vector.
  template <class Member>
  TableBuilder& list(Type type, std::string key, Member member, const Table& entries,
                     std::function<void(S&, std::size_t)> make_entry = {}) {
    Rule& rule = add(std::move(key), type, entries.documentation);
    rule.range = within(0, type == Type::keys ? 100000 : 1000);
    rule.table = &entries;
    rule.count = [member](void* s) { return std::invoke(member, *static_cast<S*>(s)).size(); };
    rule.entry = [member](void* s, std::size_t i) -> void* { return &std::invoke(member, *static_cast<S*>(s))[i]; };
    rule.append = [member, make_entry](void* p, std::size_t i) -> void* {
      S& s = *static_cast<S*>(p);
      if (make_entry) {
        make_entry(s, i);
      } else {
        std::invoke(member, s).emplace_back();
      }
      return &std::invoke(member, s).back();
    };
    return *this;
  }
  /// Rows that apply only where the selector has this name.
  TableBuilder& variant(std::string name, TableBuilder rows) {
    table_.variants.push_back({std::move(name), std::move(rows.table_.rules)});
    return *this;
  }

  // Said of the row just added.
  TableBuilder& need(Need need) {
    last().need = need;
    return *this;
  }
  TableBuilder& by_default(std::string note) {
    last().default_note = std::move(note);
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
  TableBuilder& excludes(std::string key) {
    last().excludes = std::move(key);
    return *this;
  }
  /// What more is to be done where the key is given.
  TableBuilder& when_given(std::function<void(S&)> then) {
    Rule& rule = last();
    rule.set = [then, set = rule.set](void* s, const Value& value) {
      set(s, value);
      then(*static_cast<S*>(s));
    };
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
  TableBuilder& written_if(std::function<bool(S&)> when) {
    Rule& rule = last();
    if (rule.count) {
      rule.count = [when, count = rule.count](void* s) { return when(*static_cast<S*>(s)) ? count(s) : 0; };
    } else {
      rule.get = [when, get = rule.get](void* s) { return when(*static_cast<S*>(s)) ? get(s) : Value{}; };
    }
    return *this;
  }

  /// The struct that shows the defaults, where S{} alone does not.
  TableBuilder& starting_from(S start) {
    table_.make = [start] { return std::make_shared<S>(start); };
    return *this;
  }
  /// Adds rows that other tables have too.
  TableBuilder& with(const std::function<void(TableBuilder&)>& rows) {
    rows(*this);
    return *this;
  }
  Table build() { return std::move(table_); }

 private:
  Rule& last() { return table_.rules.back(); }
  Rule& add(std::string key, Type type, std::string documentation) {
    Rule rule;
    rule.key = std::move(key);
    rule.type = type;
    rule.documentation = std::move(documentation);
    table_.rules.push_back(std::move(rule));
    return last();
  }
  template <class Member>
  Rule& bind(std::string key, Type type, Member member, std::string documentation) {
    Rule& rule = add(std::move(key), type, std::move(documentation));
    rule.get = [member](void* s) { return to_value(std::invoke(member, *static_cast<S*>(s))); };
    rule.set = [member](void* s, const Value& value) { assign(std::invoke(member, *static_cast<S*>(s)), value); };
    return rule;
  }

  Table table_;
};

}  // namespace weft::scene
