! Steps an arm from outside: a PD controller at 1 kHz. host_f [SYSTEM.toml]
module bough
  use, intrinsic :: iso_c_binding
  implicit none
  integer(c_int), parameter :: bough_inputs = 0, bough_outputs = 1

  type, bind(c) :: bough_message
    character(kind=c_char) :: text(4096), id(64), file(1024)
    integer(c_int) :: line
    character(kind=c_char) :: what(2048), advice(1024)
  end type

  interface
    integer(c_int) function bough_abi_version() bind(c)
      import :: c_int
    end function
    integer(c_int) function bough_load(file, settings, model, message) bind(c)
      import :: c_int, c_char, c_ptr, bough_message
      character(kind=c_char), intent(in) :: file(*)
      type(c_ptr), value :: settings
      type(c_ptr), intent(out) :: model
      type(bough_message), intent(out) :: message
    end function
    integer(c_int) function bough_start(model, options, simulation, message) bind(c)
      import :: c_int, c_ptr, bough_message
      type(c_ptr), value :: model, options
      type(c_ptr), intent(out) :: simulation
      type(bough_message), intent(out) :: message
    end function
    integer(c_int) function bough_find(model, kind, name) bind(c)
      import :: c_int, c_char, c_ptr
      type(c_ptr), value :: model
      integer(c_int), value :: kind
      character(kind=c_char), intent(in) :: name(*)
    end function
    real(c_double) function bough_time(simulation) bind(c)
      import :: c_double, c_ptr
      type(c_ptr), value :: simulation
    end function
    integer(c_int) function bough_set_inputs(simulation, first, n, values) bind(c)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: simulation
      integer(c_int), value :: first, n
      real(c_double), intent(in) :: values(*)
    end function
    integer(c_int) function bough_get_outputs(simulation, first, n, values) bind(c)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: simulation
      integer(c_int), value :: first, n
      real(c_double), intent(out) :: values(*)
    end function
    integer(c_int) function bough_advance(simulation, t, reached) bind(c)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: simulation
      real(c_double), value :: t
      real(c_double), intent(out) :: reached
    end function
    subroutine bough_stop(simulation) bind(c)
      import :: c_ptr
      type(c_ptr), value :: simulation
    end subroutine
    subroutine bough_unload(model) bind(c)
      import :: c_ptr
      type(c_ptr), value :: model
    end subroutine
  end interface
end module

program host
  use bough
  implicit none
  character(len=1024) :: file
  type(c_ptr) :: model, simulation
  type(bough_message) :: message
  integer(c_int) :: torque, angle, rate, status
  integer :: k
  real(c_double) :: phi(1), omega(1), command(1), reached

  file = 'system.toml'
  if (command_argument_count() > 0) call get_command_argument(1, file)
  if (bough_abi_version() /= 1) error stop 'libbough.so has another ABI version than this program'
  status = bough_load(trim(file)//c_null_char, c_null_ptr, model, message)
  if (status == 0) status = bough_start(model, c_null_ptr, simulation, message)
  if (status /= 0) then
    do k = 1, 4096
      if (message%text(k) == c_null_char) exit
      write (*, '(a)', advance='no') message%text(k)
    end do
    error stop
  end if
  torque = bough_find(model, bough_inputs, 'torque'//c_null_char)
  angle = bough_find(model, bough_outputs, 'angle'//c_null_char)
  rate = bough_find(model, bough_outputs, 'rate'//c_null_char)
  do k = 0, 1000
    status = bough_get_outputs(simulation, angle, 1, phi)
    status = bough_get_outputs(simulation, rate, 1, omega)
    if (mod(k, 200) == 0) write (*, '(f6.3, 2f15.10)') bough_time(simulation), phi, omega
    command = 60.0d0 * (0.5d0 - phi) - 12.0d0 * omega
    status = bough_set_inputs(simulation, torque, 1, command)
    status = bough_advance(simulation, 0.001d0 * (k + 1), reached)
    if (status /= 0) error stop 'the run has ended'
  end do
  call bough_stop(simulation)
  call bough_unload(model)
end program
