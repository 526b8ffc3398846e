#include "film/scene/table_builder.hpp"

#include <algorithm>
#include <cmath>

namespace weft::scene {
namespace {

const std::vector<double>& numbers_of(const Value& value) {
  return std::get<std::vector<double>>(value);
}

}  // namespace

// These functions add 0.0 to convert −0 to 0, because reading the text "-0" would give the integer 0, which is another
// value.
Value to_value(double number) {
  return std::vector<double>{number + 0.0};
}
Value to_value(int number) {
  return std::vector<double>{static_cast<double>(number)};
}
Value to_value(bool flag) {
  return flag;
}
Value to_value(const std::string& text) {
  return text;
}
Value to_value(const std::vector<std::string>& texts) {
  return texts.empty() ? Value{} : texts;
}
Value to_value(const std::filesystem::path& path) {
  return path.string();
}
Value to_value(const Vec2& v) {
  return std::vector<double>{v.x() + 0.0, v.y() + 0.0};
}
Value to_value(const Vec3& v) {
  return std::vector<double>{v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};
}
Value to_value(const Quat& q) {
  return std::vector<double>{q.w() + 0.0, q.x() + 0.0, q.y() + 0.0, q.z() + 0.0};
}

Value to_value(const std::vector<Vec3>& points) {
  std::vector<double> numbers;
  for (const Vec3& point : points)
    for (const double number : point) numbers.push_back(number + 0.0);
  return numbers.empty() ? Value{} : numbers;
}

void assign(double& target, const Value& value) {
  target = numbers_of(value)[0];
}
void assign(int& target, const Value& value) {
  target = static_cast<int>(numbers_of(value)[0]);
}
void assign(bool& target, const Value& value) {
  target = std::get<bool>(value);
}
void assign(std::string& target, const Value& value) {
  target = std::get<std::string>(value);
}
void assign(std::vector<std::string>& target, const Value& value) {
  target = std::get<std::vector<std::string>>(value);
}
void assign(std::filesystem::path& target, const Value& value) {
  target = std::get<std::string>(value);
}
void assign(Vec2& target, const Value& value) {
  target = Vec2(numbers_of(value).data());
}
void assign(Vec3& target, const Value& value) {
  target = Vec3(numbers_of(value).data());
}
void assign(Quat& target, const Value& value) {
  const std::vector<double>& wxyz = numbers_of(value);
  target = Quat(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  // A quaternion whose length is 1 up to rounding stays unchanged, so that writing and reading it again changes no bit.
  if (std::abs(target.squaredNorm() - 1) > 1e-14) target.normalize();
}

void assign(std::vector<Vec3>& target, const Value& value) {
  const std::vector<double>& numbers = numbers_of(value);
  target.clear();
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    target.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
}

Names::Names(std::initializer_list<std::string_view> names) : list(names.begin(), names.end()) {}
Names::Names(const std::vector<std::string>& names) : list(names) {}
Names::~Names() = default;

RowBuilder::RowBuilder(std::string_view documentation) {
  table_.documentation = documentation;
}
RowBuilder::~RowBuilder() = default;

void RowBuilder::add(std::string_view key, Type type, std::string_view documentation) {
  Rule& rule = table_.rules.emplace_back();
  rule.key = key;
  rule.type = type;
  rule.documentation = documentation;
}

void RowBuilder::add_number(std::string_view key, Range range, std::string_view unit, std::string_view documentation) {
  add(key, Type::number, documentation);
  last().range = range;
  last().unit = unit;
}

void RowBuilder::add_table(std::string_view key, Type type, const Table& inner) {
  add(key, type, inner.documentation);
  last().table = &inner;
}

void RowBuilder::set_components(const Names& components) {
  last().components = components.list;
}

void RowBuilder::bind(std::function<Value(void*)> get, std::function<void(void*, const Value&)> set) {
  last().get = std::move(get);
  last().set = std::move(set);
}

void RowBuilder::bind_choice(const Names& choices, std::function<std::size_t(void*)> get,
                             std::function<void(void*, std::size_t)> set) {
  last().choices = choices.list;
  bind([get = std::move(get), names = choices.list](void* s) { return Value(names.at(get(s))); },
       [set = std::move(set), names = choices.list](void* s, const Value& value) {
         const auto found = std::find(names.begin(), names.end(), std::get<std::string>(value));
         set(s, static_cast<std::size_t>(found - names.begin()));
       });
}

void RowBuilder::add_variant(std::string_view name, const RowBuilder& rows) {
  table_.variants.push_back({std::string(name), rows.table_.rules});
}

void RowBuilder::write_if(Flag when) {
  Rule& rule = last();
  if (rule.type == Type::table) {
    rule.count = [when = std::move(when)](void* s) { return std::size_t{when(s)}; };
  } else if (rule.count) {
    rule.count = [when = std::move(when), count = rule.count](void* s) { return when(s) ? count(s) : 0; };
  } else {
    rule.get = [when = std::move(when), get = rule.get](void* s) { return when(s) ? get(s) : Value{}; };
  }
}

void RowBuilder::do_when_given(std::function<void(void*)> then) {
  Rule& rule = last();
  rule.set = [then = std::move(then), set = rule.set](void* s, const Value& value) {
    set(s, value);
    then(s);
  };
}

}  // namespace weft::scene
