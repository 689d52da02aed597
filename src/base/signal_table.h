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

HEATSOAK_SIGNAL(current, current_rms_A, 0.0,
    .meaning = "equivalent DC current at the terminals; its square times the resistance of two phases in series is the heat",
    .unit = "A", .usual = 5.0, .averaging = AveragingRule::rms, .is_range_compared = true,
    .column = "current_A", .column_kind = QuantityKind::heat_input, .column_meaning = "equivalent DC current (torque per torque constant): rms over the interval, sign of its mean", .lacking = "current",
    .curve_place = 2, .curve_meaning = "rms current",
    .firmware = FirmwareInput{.field = "current_A", .meaning = "equivalent DC current (torque per torque constant), rms over the period, with the sign of the speed when the motor drives",
                              .without_power = WithoutPower::zero, .worst = WorstCase::both_directions})

HEATSOAK_SIGNAL(speed, speed_mean_rad_per_s, 0.0,
    .meaning = "mean of |ω| of the motor's shaft",
    .unit = "rad/s", .usual = 300.0, .is_motion = true, .is_range_compared = true,
    .column = "speed_rad_per_s", .column_kind = QuantityKind::heat_input, .column_meaning = "speed of the motor's shaft", .lacking = "speed",
    .curve_place = 0, .curve_meaning = "mean of |ω|",
    .firmware = FirmwareInput{.field = "speed_rad_per_s", .meaning = "speed of the motor's shaft, signed",
                              .without_power = WithoutPower::zero, .worst = WorstCase::both_directions})

HEATSOAK_QUANTITY(speed_rms, speed_rms_rad_per_s, 0.0,
    .signal = Signal::speed, .meaning = "root mean square of ω of the motor's shaft",
    .unit = "rad/s", .usual = 300.0, .averaging = AveragingRule::rms, .is_motion = true)

HEATSOAK_QUANTITY(ambient, ambient_C, 25.0,
    .meaning = "temperature of the air around the motor",
    .unit = "degC", .usual = 20.0,
    .column = "ambient_C", .column_kind = QuantityKind::surroundings, .column_meaning = "temperature of the air around the motor",
    .firmware = FirmwareInput{.field = "ambient_C", .meaning = "air around the motor; the hottest declared air if it is not measured",
                              .without_power = WithoutPower::hottest_air, .worst = WorstCase::hottest_air})

HEATSOAK_QUANTITY(resistive_headroom, resistive_headroom_V, std::numeric_limits<double>::infinity(),
    .meaning = "voltage available for I·R after the back-EMF, scaled by the heating factor of the current; it limits the current as the winding heats up; infinite: no voltage limit",
    .unit = "V", .usual = std::numeric_limits<double>::infinity(), .averaging = AveragingRule::limit)

HEATSOAK_QUANTITY(series_resistance, series_resistance_ohm, 0.0,
    .meaning = "resistance of driver and leads in series with the winding; it reduces the voltage at the winding, and its heat does not reach the motor",
    .unit = "ohm")

HEATSOAK_SIGNAL(shaft_power, shaft_power_W, 0.0,
    .meaning = "mean of M·ω: positive drives, negative brakes",
    .unit = "W", .usual = 50.0,
    .column = "torque_Nm", .column_kind = QuantityKind::heat_input, .column_unit = "Nm", .column_meaning = "torque at the motor's shaft", .lacking = "torque and speed",
    .curve_place = 4, .curve_meaning = "mechanical power; above 0 while the motor drives")

HEATSOAK_SIGNAL(input_power, input_power_W, 0.0,
    .meaning = "electrical power into the motor, or into its driver if the log says so",
    .unit = "W", .usual = 80.0, .is_range_compared = true,
    .column = "power_in_W", .from = FromColumn::value, .column_kind = QuantityKind::heat_input, .column_meaning = "electric power into the driver, its losses included", .lacking = "input power",
    .curve_place = 5, .curve_meaning = "electrical input power")

HEATSOAK_SIGNAL(modulation, modulation_ratio, 0.0,
    .meaning = "mean of |terminal voltage| / supply voltage, 0 to 1",
    .usual = 0.5,
    .column = "modulation_ratio", .column_kind = QuantityKind::heat_input, .column_meaning = "modulation of the driver, -1 … 1", .column_alias = "duty_ratio", .lacking = "modulation",
    .curve_place = 3, .curve_meaning = "ratio |V_motor|/V_bus")

HEATSOAK_SIGNAL(bus_voltage, bus_V, 0.0,
    .meaning = "supply voltage of the driver",
    .unit = "V", .usual = 24.0,
    .column = "bus_V", .from = FromColumn::value, .column_kind = QuantityKind::heat_input, .column_meaning = "voltage of the supply at the driver", .lacking = "supply voltage",
    .curve_place = 7, .curve_meaning = "voltage of the supply")

HEATSOAK_SIGNAL(vehicle_speed, vehicle_speed_m_per_s, 0.0,
    .meaning = "mean of the magnitude of the robot's speed, which is the speed of the air past the motor",
    .unit = "m/s", .usual = 2.0, .is_motion = true, .is_range_compared = true,
    .column = "vehicle_speed_m_per_s", .from = FromColumn::magnitude, .column_meaning = "speed of the robot over the ground, mean of its magnitude; without wind the air passes the motor at this speed", .lacking = "vehicle speed",
    .curve_place = 8, .curve_meaning = "magnitude of the vehicle's speed",
    .firmware = FirmwareInput{.field = "vehicle_speed_m_per_s", .meaning = "speed of the robot through the air, not of its wheels; 0 if it is not known",
                              .without_power = WithoutPower::zero,
                              .unmeasured = "the robot's speed through the air, which the core does not know: it uses the speed with the most heating, still air if wind cools"})

// The guard has the hottest neighbour, so that it never underestimates their heat.
HEATSOAK_SIGNAL(neighbour_temperature, neighbour_C, 25.0,
    .meaning = "temperature of the neighbouring motor; of several, logs and simulations have the mean, and the guard in the firmware the hottest",
    .unit = "degC", .usual = 90.0, .is_optional = true,
    .column = "neighbour_C", .from = FromColumn::value, .column_kind = QuantityKind::surroundings, .column_meaning = "temperature of the neighbouring motor, of several their mean", .lacking = "temperature of the neighbour",
    .unstated = {.consequence = "is left out", .quantity = "the neighbour's temperature"},
    .firmware = FirmwareInput{.field = "neighbour_C", .meaning = "temperature of the neighbouring motor, of several the hottest; the winding's limit if it is not known",
                              .without_power = WithoutPower::winding_limit,
                              .unmeasured = "the neighbouring motors: the core uses the hottest of the other wheels' guards"})

HEATSOAK_QUANTITY(unlogged_speed_share, unlogged_speed_share, 0.0,
    .meaning = "1 if the machine may turn at a speed that was not logged, else 0",
    .unit = "")

HEATSOAK_SIGNAL(age, age_h, 0.0,
    .meaning = "operating hours of the motor so far",
    .unit = "h", .usual = 100.0,
    .column = "age_h", .from = FromColumn::value, .column_meaning = "operating hours of the motor", .lacking = "hours of running",
    .unstated = {.consequence = "is that of a new motor", .quantity = "the operating hours"},
    .curve_place = 9, .curve_meaning = "operating hours",
    .firmware = FirmwareInput{.field = "age_h", .meaning = "operating hours of the motor", .without_power = WithoutPower::any,
                              .searched = {.low = 1e-2, .high = 1e5, .count = 141, .is_by_ratio = true}, .plausible = InputRange{0.0, 1e6},
                              .unmeasured = "operating hours, which the core does not know: it uses the age with the most heating"})

HEATSOAK_QUANTITY(velocity, velocity_rad_per_s, 0.0,
    .signal = Signal::speed, .meaning = "signed mean of ω of the motor's shaft; a log of |ω| does not provide the sign",
    .unit = "rad/s", .usual = 300.0, .magnitude = "speed", .is_motion = true,
    .curve_place = 1, .curve_meaning = "speed ω with its sign")

HEATSOAK_QUANTITY(acceleration, acceleration_rad_per_s2, 0.0,
    .signal = Signal::speed, .meaning = "mean of |dω/dt| of the motor's shaft",
    .unit = "rad/s2", .usual = 100.0, .is_motion = true,
    .curve_place = 6, .curve_meaning = "mean of |dω/dt|",
    .firmware = FirmwareInput{.field = "acceleration_rad_per_s2", .meaning = "magnitude of dω/dt of the motor's shaft, mean over the period",
                              .without_power = WithoutPower::zero, .searched = {.low = 1.0, .high = 1e6, .count = 241, .is_by_ratio = true}})

HEATSOAK_QUANTITY(first_column, first_column, 0.0,
    .meaning = "column of a log in its own unit: abscissa of a measured curve over none of the other signals", .is_optional = true)
HEATSOAK_QUANTITY(second_column, second_column, 0.0,
    .meaning = "as first_column, for a second curve", .is_optional = true)
HEATSOAK_QUANTITY(third_column, third_column, 0.0,
    .meaning = "as first_column, for a third curve", .is_optional = true)

HEATSOAK_QUANTITY(copper_loss, copper_loss_W, 0.0,
    .meaning = "copper loss of the network, which its drive stage sets before the laws are evaluated",
    .unit = "W", .usual = 10.0)

// clang-format on

#undef HEATSOAK_SIGNAL
#undef HEATSOAK_QUANTITY
