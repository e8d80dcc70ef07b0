function Phi_R = treeflx_rigid(dof_map, xyz, R)
% TREEFLX_RIGID  ndof x 6: unit translations x y z, unit rotations about R.
%   dof_map: ndof x 2, node (from 1) and code: 1 2 3 translations, 4 5 6 rotations, else a generalized dof.
ndof = size(dof_map, 1);
Phi_R = zeros(ndof, 6);
one = eye(3);
for i = 1:ndof
  code = dof_map(i, 2);
  if code < 1 || code > 6, continue, end
  Phi_R(i, code) = 1;
  if code <= 3
    p = xyz(dof_map(i, 1), :) - R(:)';
    for s = 1:3
      turned = cross(one(s, :), p);
      Phi_R(i, 3 + s) = turned(code);
    end
  end
end
end
