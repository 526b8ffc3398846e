#include "film/scene/pressure_rules.hpp"

#include "film/scene/common_rules.hpp"
#include "film/scene/table_builder.hpp"
#include "physics/model/pressure.hpp"

namespace weft::scene {
namespace {

/// Name, range, unit and documentation of the quantity that belongs to one PressureControl.
struct Quantity {
  const char* key;
  Range range;
  const char* unit;
  const char* documentation;
};

Table key_table(const Quantity& quantity) {
  return TableBuilder<PressureKey>("The air inside at one time.")
      .with(key_time_row<PressureKey>)
      .number(quantity.key, &PressureKey::value, quantity.range, quantity.unit, quantity.documentation)
      .by_default(kDefaultOfKey)
      .build();
}

/// Adds the rows of the quantity, its interpolation and its key frames.
void quantity_rows(TableBuilder<Pressure>& rows, const Quantity& quantity, const Table& keys) {
  rows.number(quantity.key, &Pressure::value, quantity.range, quantity.unit, quantity.documentation)
      .choice("interpolation", &Pressure::interpolation, kInterpolations, kBetweenKeys)
      .list(Type::keys, "keys", &Pressure::keys, keys, [](Pressure& pressure, std::size_t i) {
        pressure.keys.push_back(i == 0 ? PressureKey{0, pressure.value} : PressureKey(pressure.keys.back()));
      });
}

}  // namespace

const Table& pressure_rules() {
  // The ranges only keep sums finite. They are far above real values: silk bursts at a few kPa, and 1e9 m³ are a cubic
  // kilometre.
  static const Quantity kGauge = {"gauge", within(-1e6, 1e6), "Pa",
                                  "pressure inside minus pressure outside; negative: it draws the cloth in"};
  static const Quantity kAir = {
      "air", within(-1e9, 1e9), "m³",
      "air pumped in after the cloth is closed, as volume at the pressure outside; negative: pumped out"};
  static const Quantity kFill = {
      "fill", within(0, 1e6), "",
      "amount of air inside, relative to the volume that the cloth encloses when it is closed"};
  static const Table kGaugeKeys = key_table(kGauge), kAirKeys = key_table(kAir), kFillKeys = key_table(kFill);
  using Rows = TableBuilder<Pressure>;
  static const Table kTable =
      TableBuilder<Pressure>(
          "Air that the cloth encloses, from the start or, if it is sewn, from the end of sewing. An opening counts as "
          "closed by triangles from its border to the middle of that border.")
          .choice("control", &Pressure::control, {"gauge", "air", "fill"},
                  "quantity that the scene gives: the pressure (gauge), or the amount of air (air, fill); the pressure "
                  "of a given amount follows from the volume at constant temperature, with 101325 Pa outside")
          .when_given([](Pressure& p) { p.value = p.control == PressureControl::fill ? 1 : 0; })
          .selects()
          .variant("gauge", Rows().with([](auto& rows) { quantity_rows(rows, kGauge, kGaugeKeys); }))
          .variant("air", Rows().with([](auto& rows) { quantity_rows(rows, kAir, kAirKeys); }))
          .variant("fill", Rows().with([](auto& rows) { quantity_rows(rows, kFill, kFillKeys); }))
          .build();
  return kTable;
}

}  // namespace weft::scene
