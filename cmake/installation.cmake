# Install rules for `cmake --install`. The program finds its data relative to itself, in ../share/heatsoak and ../lib/heatsoak.
# The second path is lib/heatsoak on every system, even where library folders have another name.
include(GNUInstallDirs)

set(HEATSOAK_SHARE "${CMAKE_INSTALL_DATADIR}/heatsoak")
set(DATA_ONLY FILES_MATCHING PATTERN "*.toml" PATTERN "*.csv" PATTERN "*.md" PATTERN "*.h")

install(TARGETS heatsoak RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
install(TARGETS heatsoak_charts LIBRARY DESTINATION "${CMAKE_INSTALL_BINDIR}/../lib/heatsoak")
install(DIRECTORY motor_db/ DESTINATION "${HEATSOAK_SHARE}/motor_db" ${DATA_ONLY})
install(DIRECTORY duty_profiles/ DESTINATION "${HEATSOAK_SHARE}/duty_profiles" ${DATA_ONLY})
install(DIRECTORY robot_core/robots/ DESTINATION "${HEATSOAK_SHARE}/robots" ${DATA_ONLY})
# Logs and check file that the examples in the help texts use.
install(DIRECTORY reports/soak reports/friction_test reports/check DESTINATION "${HEATSOAK_SHARE}/reports" ${DATA_ONLY})
# README.md and the files that it links to, in the folders that the links expect.
install(FILES LICENSE README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY docs reports DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY "${PROJECT_BINARY_DIR}/man1" DESTINATION "${CMAKE_INSTALL_MANDIR}")
install(FILES motor_db/README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}/motor_db")
install(FILES robot_core/robots/README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}/robot_core/robots")
