# What `cmake --install` puts where. The program looks for the rest beside itself: ../share/heatsoak and
# ../lib/heatsoak, the latter whatever this system calls its folder of libraries.
include(GNUInstallDirs)

set(HEATSOAK_SHARE "${CMAKE_INSTALL_DATADIR}/heatsoak")
set(DATA_ONLY FILES_MATCHING PATTERN "*.toml" PATTERN "*.csv" PATTERN "*.md" PATTERN "*.h")

install(TARGETS heatsoak RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
install(TARGETS heatsoak_charts LIBRARY DESTINATION "${CMAKE_INSTALL_BINDIR}/../lib/heatsoak")
install(DIRECTORY motor_db/ DESTINATION "${HEATSOAK_SHARE}/motor_db" ${DATA_ONLY})
install(DIRECTORY duty_profiles/ DESTINATION "${HEATSOAK_SHARE}/duty_profiles" ${DATA_ONLY})
install(DIRECTORY robot_core/robots/ DESTINATION "${HEATSOAK_SHARE}/robots" ${DATA_ONLY})
# The logs and the check file that the examples of the help begin from.
install(DIRECTORY reports/soak reports/friction_test reports/check DESTINATION "${HEATSOAK_SHARE}/reports" ${DATA_ONLY})
# The page of the project, and what it links to where it links to it.
install(FILES LICENSE README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY docs reports DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY "${PROJECT_BINARY_DIR}/man1" DESTINATION "${CMAKE_INSTALL_MANDIR}")
install(FILES motor_db/README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}/motor_db")
install(FILES robot_core/robots/README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}/robot_core/robots")
