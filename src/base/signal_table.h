// The table of signals: one row for each number that a thermal law may depend on besides the temperatures of its nodes. The names of the
// attributes are those of base::SignalRow, in its order. No include guard: signals.h and thermal/operating_point.h include this file with
// macros of their own.
//
// HEATSOAK_SIGNAL(name, member, default, attributes…)    a signal of a log, with an enumerator of base::Signal
// HEATSOAK_QUANTITY(name, member, default, attributes…)  a number without one, computed from signals or set by the program
//
// `member` is that of thermal::OperatingPoint, with its unit; `default` is its value if nothing states it. The order of the rows is that of
// the members and of the signals in lists.
#ifndef HEATSOAK_QUANTITY
#define HEATSOAK_QUANTITY HEATSOAK_SIGNAL
#endif

// clang-format off

// Equivalent DC current at the terminals: I² times the resistance of two phases in series is the heat.
HEATSOAK_SIGNAL(current, current_rms_A, 0.0,
    .unit = "A", .usual = 5.0, .averaging = AveragingRule::rms, .is_range_compared = true,
    .column = "current_A", .column_kind = QuantityKind::heat_input, .column_meaning = "equivalent DC current (torque per torque constant): rms over the interval, sign of its mean", .lacking = "current",
    .curve_place = 2, .curve_meaning = "rms current",
    .firmware = FirmwareInput{.field = "current_A", .meaning = "equivalent DC current (torque per torque constant), rms over the period, with the sign of the speed when the motor drives",
                              .without_power = WithoutPower::zero, .worst = WorstCase::both_directions})

// Mean of |ω|, motor shaft.
HEATSOAK_SIGNAL(speed, speed_mean_rad_per_s, 0.0,
    .unit = "rad/s", .usual = 300.0, .is_motion = true, .is_range_compared = true,
    .column = "speed_rad_per_s", .column_kind = QuantityKind::heat_input, .column_meaning = "speed of the motor's shaft", .lacking = "speed",
    .curve_place = 0, .curve_meaning = "mean of |ω|",
    .firmware = FirmwareInput{.field = "speed_rad_per_s", .meaning = "speed of the motor's shaft, signed",
                              .without_power = WithoutPower::zero, .worst = WorstCase::both_directions})

// Root mean square of ω, motor shaft.
HEATSOAK_QUANTITY(speed_rms, speed_rms_rad_per_s, 0.0,
    .signal = Signal::speed, .unit = "rad/s", .usual = 300.0, .averaging = AveragingRule::rms, .is_motion = true)

HEATSOAK_QUANTITY(ambient, ambient_C, 25.0,
    .unit = "degC", .usual = 20.0,
    .column = "ambient_C", .column_kind = QuantityKind::surroundings, .column_meaning = "temperature of the air around the motor",
    .firmware = FirmwareInput{.field = "ambient_C", .meaning = "air around the motor; the hottest declared air if it is not measured",
                              .without_power = WithoutPower::hottest_air, .worst = WorstCase::hottest_air})

// Voltage available for I·R after the back-EMF, scaled by the heating factor of the current. As the winding heats up and its resistance
// rises, it limits the current. Infinite: no voltage limit.
HEATSOAK_QUANTITY(resistive_headroom, resistive_headroom_V, std::numeric_limits<double>::infinity(),
    .unit = "V", .usual = std::numeric_limits<double>::infinity(), .averaging = AveragingRule::limit)

// Resistance of driver and leads in series with the winding. It reduces the voltage at the winding; its heat does not reach the motor.
HEATSOAK_QUANTITY(series_resistance, series_resistance_ohm, 0.0,
    .unit = "ohm")

// Mean of M·ω: positive drives, negative brakes. Its log column is the torque.
HEATSOAK_SIGNAL(shaft_power, shaft_power_W, 0.0,
    .unit = "W", .usual = 50.0,
    .column = "torque_Nm", .column_kind = QuantityKind::heat_input, .column_unit = "Nm", .column_meaning = "torque at the motor's shaft", .lacking = "torque and speed",
    .curve_place = 4, .curve_meaning = "mechanical power; above 0 while the motor drives")

// Electrical power into the motor, or into its driver, if the log says so.
HEATSOAK_SIGNAL(input_power, input_power_W, 0.0,
    .unit = "W", .usual = 80.0, .is_range_compared = true,
    .column = "power_in_W", .from = FromColumn::value, .column_kind = QuantityKind::heat_input, .column_meaning = "electric power into the driver, its losses included", .lacking = "input power",
    .curve_place = 5, .curve_meaning = "electrical input power")

// Mean of |terminal voltage| / supply voltage, 0 to 1.
HEATSOAK_SIGNAL(modulation, modulation_ratio, 0.0,
    .usual = 0.5,
    .column = "modulation_ratio", .column_kind = QuantityKind::heat_input, .column_meaning = "modulation of the driver, -1 … 1", .column_alias = "duty_ratio", .lacking = "modulation",
    .curve_place = 3, .curve_meaning = "ratio |V_motor|/V_bus")

// Supply voltage of the driver.
HEATSOAK_SIGNAL(bus_voltage, bus_V, 0.0,
    .unit = "V", .usual = 24.0,
    .column = "bus_V", .from = FromColumn::value, .column_kind = QuantityKind::heat_input, .column_meaning = "voltage of the supply at the driver", .lacking = "supply voltage",
    .curve_place = 7, .curve_meaning = "voltage of the supply")

// Mean of the speed's magnitude.
HEATSOAK_SIGNAL(vehicle_speed, vehicle_speed_m_per_s, 0.0,
    .unit = "m/s", .usual = 2.0, .is_motion = true, .is_range_compared = true,
    .column = "vehicle_speed_m_per_s", .from = FromColumn::magnitude, .column_meaning = "speed over ground: airflow", .lacking = "vehicle speed",
    .curve_place = 8, .curve_meaning = "magnitude of the vehicle's speed",
    .firmware = FirmwareInput{.field = "vehicle_speed_m_per_s", .meaning = "speed of the robot through the air, not of its wheels; 0 if it is not known",
                              .without_power = WithoutPower::zero,
                              .unmeasured = "the robot's speed through the air, which the core does not know: it uses the speed with the most heating, still air if wind cools"})

// Temperature of the neighbouring motor. Of several, logs and simulations have the mean, and the guard in the firmware the hottest, so that
// it never underestimates their heat.
HEATSOAK_SIGNAL(neighbour_temperature, neighbour_C, 25.0,
    .unit = "degC", .usual = 90.0, .is_optional = true,
    .column = "neighbour_C", .from = FromColumn::value, .column_kind = QuantityKind::surroundings, .column_meaning = "temperature of the neighbouring motor, of several their mean", .lacking = "temperature of the neighbour",
    .unstated = {.consequence = "is left out", .quantity = "the neighbour's temperature"},
    .firmware = FirmwareInput{.field = "neighbour_C", .meaning = "temperature of the neighbouring motor, of several the hottest; the winding's limit if it is not known",
                              .without_power = WithoutPower::winding_limit,
                              .unmeasured = "the neighbouring motors: the core uses the hottest of the other wheels' guards"})

// 1 if the machine may turn at a speed that was not logged, else 0.
HEATSOAK_QUANTITY(unlogged_speed_share, unlogged_speed_share, 0.0,
    .unit = "")

// Operating hours so far.
HEATSOAK_SIGNAL(age, age_h, 0.0,
    .unit = "h", .usual = 100.0,
    .column = "age_h", .from = FromColumn::value, .column_meaning = "operating hours of the motor", .lacking = "hours of running",
    .unstated = {.consequence = "is that of a new motor", .quantity = "the operating hours"},
    .curve_place = 9, .curve_meaning = "operating hours",
    .firmware = FirmwareInput{.field = "age_h", .meaning = "operating hours of the motor", .without_power = WithoutPower::any,
                              .searched = {.low = 1e-2, .high = 1e5, .count = 141, .is_by_ratio = true}, .plausible = InputRange{0.0, 1e6},
                              .unmeasured = "operating hours, which the core does not know: it uses the age with the most heating"})

// Signed mean of ω, motor shaft; a log of |ω| does not provide the sign.
HEATSOAK_QUANTITY(velocity, velocity_rad_per_s, 0.0,
    .signal = Signal::speed, .unit = "rad/s", .usual = 300.0, .is_motion = true,
    .curve_place = 1, .curve_meaning = "speed ω with its sign")

// Mean of |dω/dt|, motor shaft.
HEATSOAK_QUANTITY(acceleration, acceleration_rad_per_s2, 0.0,
    .signal = Signal::speed, .unit = "rad/s2", .usual = 100.0, .is_motion = true,
    .curve_place = 6, .curve_meaning = "mean of |dω/dt|",
    .firmware = FirmwareInput{.field = "acceleration_rad_per_s2", .meaning = "magnitude of dω/dt of the motor's shaft, mean over the period",
                              .without_power = WithoutPower::zero, .searched = {.low = 1.0, .high = 1e6, .count = 241, .is_by_ratio = true}})

// Columns of a log, in their own units: abscissas of tabulated curves over none of the signals above.
HEATSOAK_QUANTITY(first_column, first_column, 0.0, .is_optional = true)
HEATSOAK_QUANTITY(second_column, second_column, 0.0, .is_optional = true)
HEATSOAK_QUANTITY(third_column, third_column, 0.0, .is_optional = true)

// Copper loss of the network, which its drive stage sets before the laws are evaluated.
HEATSOAK_QUANTITY(copper_loss, copper_loss_W, 0.0,
    .unit = "W", .usual = 10.0)

// clang-format on

#undef HEATSOAK_SIGNAL
#undef HEATSOAK_QUANTITY
