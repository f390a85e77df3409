"""Arms of serial bus servos, such as the SO-101.

    from jiling_arm.ik.robot import create_so101_5dof
    robot = create_so101_5dof()
    q, success, reason = robot.ikine_LM(robot.fkine([0.1] * 5), mask=[1, 1, 1, 0, 0, 0])
"""
