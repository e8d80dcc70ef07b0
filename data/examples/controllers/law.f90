! The law of law.c in Fortran.
!     gfortran -shared -fPIC law.f90 -o liblaw.so
module law
  use, intrinsic :: iso_c_binding
  implicit none

  type, bind(c) :: bough_controller
    integer(c_int) :: inputs, num_parameters
    type(c_ptr) :: parameters
    integer(c_int) :: outputs, states, memory, has_feedthrough
    real(c_double) :: sample_time
    type(c_ptr) :: instance
  end type

  type :: law_data
    real(c_double) :: k, c, tau
  end type

contains

  integer(c_int) function version() bind(c, name="bough_controller_version")
    version = 1
  end function

  integer(c_int) function open_law(controller) bind(c, name="bough_controller_open")
    type(bough_controller), intent(inout) :: controller
    type(law_data), pointer :: law
    real(c_double), pointer :: p(:)
    open_law = 1
    if (controller%inputs /= 2 .or. controller%num_parameters /= 3) return
    call c_f_pointer(controller%parameters, p, [3])
    allocate (law)
    law%k = p(1)
    law%c = p(2)
    law%tau = p(3)
    controller%states = 1
    controller%instance = c_loc(law)
    open_law = 0
  end function

  integer(c_int) function outputs(instance, t, u, z, d, y) bind(c, name="bough_controller_outputs")
    type(c_ptr), value :: instance
    real(c_double), value :: t
    real(c_double), intent(in) :: u(2), z(1), d(*)
    real(c_double), intent(out) :: y(1)
    type(law_data), pointer :: law
    call c_f_pointer(instance, law)
    y(1) = -law%k * u(1) - law%c * z(1)
    outputs = 0
  end function

  integer(c_int) function derivatives(instance, t, u, z, d, z_dot) bind(c, name="bough_controller_derivatives")
    type(c_ptr), value :: instance
    real(c_double), value :: t
    real(c_double), intent(in) :: u(2), z(1), d(*)
    real(c_double), intent(out) :: z_dot(1)
    type(law_data), pointer :: law
    call c_f_pointer(instance, law)
    z_dot(1) = (u(2) - z(1)) / law%tau
    derivatives = 0
  end function

  subroutine close_law(instance) bind(c, name="bough_controller_close")
    type(c_ptr), value :: instance
    type(law_data), pointer :: law
    call c_f_pointer(instance, law)
    deallocate (law)
  end subroutine

end module
