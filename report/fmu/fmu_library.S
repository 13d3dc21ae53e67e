/* The shared library of an FMU as bytes of the program; RIGCAL_FMU_LIBRARY is its file. */
    .section .rodata
    .global rigcal_fmu_library_begin
    .global rigcal_fmu_library_end
rigcal_fmu_library_begin:
    .incbin RIGCAL_FMU_LIBRARY
rigcal_fmu_library_end:
    .byte 0
    .section .note.GNU-stack, "", %progbits
